#pragma once

#include <Eigen/Core>
#include <cmath>

#include "cairn/geometry/se3.h"

namespace cairn {

/// {T · diag(s) · u : |u| ≤ 1}: `T` takes the ellipsoid's frame (origin at its centre, along its
/// axes) to the world, `semi_axes` are positive, metres.
struct Ellipsoid {
  SE3 T;
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Ones();

  const Eigen::Vector3d& centre() const { return T.translation(); }
  double volume() const { return 4.0 / 3.0 * M_PI * semi_axes.prod(); }
  /// Along a unit vector, from the centre to the tangent plane.
  double reach(const Eigen::Vector3d& direction) const {
    return semi_axes.cwiseProduct(T.rotation().conjugate() * direction).norm();
  }
  bool contains(const Eigen::Vector3d& x) const {
    return (T.inverse() * x).cwiseQuotient(semi_axes).squaredNorm() <= 1;
  }
};

/// Volume of the intersection over that of the union. An affine map makes the smaller one the unit
/// ball; along rays from its centre the share inside the other one is exact, and the rays are a
/// Fibonacci lattice on the sphere, so that the result is deterministic and its error below 0.002
/// (below 0.005 also for needles and discs of 1 : 20).
double intersection_over_union(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace cairn
