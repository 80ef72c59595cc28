#pragma once

#include <Eigen/Core>
#include <cmath>

namespace cairn {

/// The i-th of `count` unit vectors that cover the sphere evenly: a Fibonacci lattice.
inline Eigen::Vector3d sphere_lattice(int i, int count) {
  static const double kGoldenAngle = M_PI * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * i + 1.0) / count, radius = std::sqrt(1 - z * z);
  return {radius * std::cos(kGoldenAngle * i), radius * std::sin(kGoldenAngle * i), z};
}

}  // namespace cairn
