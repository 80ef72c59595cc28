#pragma once

#include <span>

#include "cairn/map/map.h"
#include "cairn/mapping/plane_evidence.h"

namespace cairn {

/// Lets points decide where a plane lies, as far as there are any: a robust fit in which the
/// prediction (normal, offset at the centroid, with their σ) counts as much as it is sure. `points`
/// in the plane's frame; `point_sigma`: by which points may lie off it, as a share of its distance.
/// Returns how many lie on it.
int refine_plane(SeenPlane& seen, std::span<const PlanePoint> points, double point_sigma);

/// Measured points at these keypoints, in the keyframe's frame; those without a point are left out.
/// `point_sigma`: by which they may lie off a plane, as a share of their viewing distance.
std::vector<PlanePoint> plane_points(const Map& map, const Keyframe& keyframe,
                                     const std::vector<std::uint32_t>& keypoints,
                                     double point_sigma);

/// The same for a landmark, unless it is confirmed, which the adjustment moves: by all that
/// pictures said of it, the points in their masks and, if `manhattan`, the confirmed planes that it
/// seems to be parallel or perpendicular to. Then what is known of it: from which side it is seen,
/// its points, its outline and the evidence. `point_sigma`: of points off a plane, as a share of
/// their viewing distance.
void refine_landmark(Map& map, PlaneId id, double point_sigma, bool manhattan);

}  // namespace cairn
