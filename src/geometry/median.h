#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace cairn {

/// Of two middle values the larger one. Not for empty lists; the values change their order.
inline double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// σ of a normal distribution whose absolute deviations these are, by their median. Not for empty
/// lists; the values change their order.
inline double robust_sigma(std::span<double> deviations) { return 1.4826 * median(deviations); }

/// The same of values around their own median.
inline double robust_spread(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  return robust_sigma(values);
}

}  // namespace cairn
