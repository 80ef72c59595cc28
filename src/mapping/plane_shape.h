#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// Where a plane is surface, as most of what its pictures say of each place that they look at: in
/// the mask, or not; with holes and narrow gaps closed. An L stays an L; parts that are far from
/// each other get a convex outline. Corners in the world, in order, counter-clockwise seen from
/// where the normal points; for people and files.
std::vector<Eigen::Vector3d> plane_shape(const Map& map, PlaneId id);

}  // namespace cairn
