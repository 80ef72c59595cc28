#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace cairn {

/// Seconds in which what networks say changes (docs/perception_noise.md).
inline constexpr double kNetworkErrorsLast = 1.5;

/// How many pictures without common errors those taken at these times (seconds) are worth.
inline double independent_pictures(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  double independent = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    independent += 1 - std::exp(-(times[i] - times[i - 1]) / kNetworkErrorsLast);
  }
  return independent;
}

}  // namespace cairn
