#pragma once

// Planes for tests, and a matcher that says by how much two of them differ.

#include <gmock/gmock.h>

#include <cmath>
#include <ostream>

#include "cairn/geometry/plane.h"
#include "geometry/scene.h"

namespace cairn::testing {

/// Passes for planes that hold the same points, whichever their sign: normals within
/// `max_angle_deg`, distances from the origin within `max_offset`.
MATCHER_P3(IsNearPlane, expected, max_angle_deg, max_offset,
           "is the plane of normal (" + ::testing::PrintToString(expected.normal().x()) + ", " +
               ::testing::PrintToString(expected.normal().y()) + ", " +
               ::testing::PrintToString(expected.normal().z()) + ") and offset " +
               ::testing::PrintToString(expected.offset())) {
  const Plane same_side = arg.normal().dot(expected.normal()) < 0 ? arg.flipped() : arg;
  const double angle_deg = angle_between(arg, expected) * 180 / M_PI;
  const double offset = same_side.offset() - expected.offset();
  *result_listener << "which is turned by " << angle_deg << " degrees and off by " << offset;
  return angle_deg <= max_angle_deg && std::abs(offset) <= max_offset;
}

/// Any orientation, up to `farthest` units from the origin, either side positive.
inline Plane random_plane(Random& random, double farthest) {
  const Eigen::Vector3d normal = random.direction();
  return Plane(normal, random.uniform(-farthest, farthest));
}

/// On the plane, up to `reach` units from the foot of the origin.
inline Eigen::Vector3d point_on(const Plane& plane, Random& random, double reach) {
  const auto axes = tangent_axes(plane.normal());
  const double u = random.uniform(-reach, reach), v = random.uniform(-reach, reach);
  return -plane.offset() * plane.normal() + axes * Eigen::Vector2d(u, v);
}

}  // namespace cairn::testing

namespace cairn {

/// For failure messages.
inline void PrintTo(const Plane& plane, std::ostream* out) {
  *out << "plane of normal (" << plane.normal().transpose() << ") and offset " << plane.offset();
}

}  // namespace cairn
