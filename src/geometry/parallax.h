#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

namespace cairn {

/// The largest angle between two of the rays to `point` from where its views were taken, radians; 0
/// with fewer than two. `eye_of` gives the place of a view.
template <typename Views, typename EyeOf = std::identity>
double largest_parallax(const Views& views, const Eigen::Vector3d& point, EyeOf eye_of = {}) {
  double least = 1;  // cosine
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Vector3d ray = (point - eye_of(views[i])).normalized();
    for (std::size_t k = 0; k < i; ++k) {
      least = std::min(least, ray.dot((point - eye_of(views[k])).normalized()));
    }
  }
  return std::acos(std::max(least, -1.0));
}

}  // namespace cairn
