#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// A closed surface; corners of triangles counter-clockwise as seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;  ///< indices into `vertices`
};

/// The surface of an ellipsoid in 192 triangles, between circles of latitude and longitude around
/// its third axis.
TriangleMesh ellipsoid_mesh(const Ellipsoid& ellipsoid);

}  // namespace cairn
