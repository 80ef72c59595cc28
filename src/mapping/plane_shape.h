#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// What of its surface the pictures of a plane have shown: the union of their masks, but for what
/// hardly any of them shows, with its holes and narrow gaps closed. An L stays an L. Corners in the
/// world, in order, counter-clockwise seen from where the normal points; for people and files.
/// Where the parts are far from each other it is the convex outline of the landmark.
std::vector<Eigen::Vector3d> plane_shape(const Map& map, PlaneId id);

}  // namespace cairn
