#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace cairn {

/// Of two middle values the larger one. Not for empty lists; the values change their order.
inline double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value at a rank from 0 (least) to 1 (greatest), of two the lower one. Not for empty lists;
/// the values change their order.
template <class T>
T quantile(std::vector<T>& values, double rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

constexpr double kSigmaOfMedian = 1.4826;  ///< σ over median absolute deviation, if normal

/// σ of a normal distribution whose absolute deviations these are, by their median. Not for empty
/// lists; the values change their order.
inline double robust_sigma(std::span<double> deviations) {
  return kSigmaOfMedian * median(deviations);
}

/// The same of values around their own median.
inline double robust_spread(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  return robust_sigma(values);
}

struct WeightedValue {
  double value = 0, weight = 1;
};

/// Below and above it is at most half of the weight. Not for empty lists.
inline double median(std::vector<WeightedValue> values) {
  std::sort(values.begin(), values.end(),
            [](const WeightedValue& a, const WeightedValue& b) { return a.value < b.value; });
  double above = 0;
  for (const WeightedValue& v : values) above += v.weight;
  const double half = above / 2;
  for (const WeightedValue& v : values) {
    above -= v.weight;
    if (above <= half) return v.value;
  }
  return values.back().value;
}

/// Mean of the values within `gate` robust σ of their median. Not for empty lists.
inline double robust_mean(std::vector<double> values, double gate) {
  const double width = gate * robust_spread(values), middle = median(values);
  std::erase_if(values, [&](double value) { return std::abs(value - middle) > width; });
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

}  // namespace cairn
