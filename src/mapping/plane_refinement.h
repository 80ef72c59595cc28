#pragma once

#include <span>

#include "cairn/map/map.h"

namespace cairn {

/// Lets points decide where a plane lies, as far as there are any: a robust fit in which the
/// prediction (normal, offset at the centroid, with their σ) counts as much as it is sure. `points`
/// in the plane's frame; `sigma`: of their distances from a plane. Returns how many lie on it.
int refine_plane(SeenPlane& seen, std::span<const Eigen::Vector3d> points, double sigma);

/// The same for a landmark, unless it is confirmed, which the adjustment moves: by all that
/// pictures said of it, the points in their masks and, if `manhattan`, the confirmed planes that it
/// seems to be parallel or perpendicular to. Then what is known of it: its points, its outline and
/// the evidence. `point_sigma`: of points off a plane, as a share of their viewing distance.
void refine_landmark(Map& map, PlaneId id, double point_sigma, bool manhattan);

}  // namespace cairn
