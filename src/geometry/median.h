#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace cairn {

/// Of two middle values the larger one. Not for empty lists; the values change their order.
inline double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace cairn
