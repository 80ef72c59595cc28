#pragma once

#include <Eigen/Core>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// {T · x : |x_k| ≤ half_k}: `T` takes the cuboid's frame (origin at its centre, along its edges)
/// to the world; `half` its edges are positive, metres.
struct Cuboid {
  SE3 T;
  Eigen::Vector3d half = Eigen::Vector3d::Ones();

  double volume() const { return 8 * half.prod(); }
};

/// The one around an ellipsoid, along its axes.
Cuboid cuboid_of(const Ellipsoid& ellipsoid);

/// Volume of the intersection over that of the union, exact but for rounding. The intersection is
/// bounded by what of each one's faces is inside of the other one; its volume comes from them by
/// the theorem of divergence.
double intersection_over_union(const Cuboid& a, const Cuboid& b);

}  // namespace cairn
