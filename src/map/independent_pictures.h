#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace cairn {

/// How many pictures without common errors those taken at these times (seconds) are worth: what
/// networks say changes within a second or two (docs/perception_noise.md).
inline double independent_pictures(std::vector<double> times) {
  constexpr double kErrorsLast = 1.5;  // seconds
  std::sort(times.begin(), times.end());
  double independent = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    independent += 1 - std::exp(-(times[i] - times[i - 1]) / kErrorsLast);
  }
  return independent;
}

}  // namespace cairn
