#pragma once

#include <memory>
#include <optional>
#include <span>

#include "cairn/map/map_view.h"
#include "cairn/tracking/tracker.h"

namespace cairn {

/// Where a lost camera was found again.
struct Relocalization {
  std::shared_ptr<const MapView> view;  ///< around the keyframe that it was found by
  SE3 T_wc;
  std::vector<PointId> points;  ///< one a keypoint
  int inliers = 0;              ///< points; none where objects alone say where it is
  int objects = 0;              ///< that agree, where it was found by them
};

/// Finds a frame in the map: descriptors against each candidate keyframe, resection by P3P within
/// RANSAC, then the points around that keyframe by projection; of the poses that hold the one with
/// the most points. Pure: it changes nothing. `seed` steers the random samples.
std::optional<Relocalization> relocalize(const Frame& frame, const Map& map,
                                         std::span<const KeyframeId> candidates,
                                         const TrackingOptions& options, std::uint64_t seed);

/// Finds a frame by the objects that it shows (relocalize_by_objects), then the points around the
/// keyframes that see most of what that pose sees, by projection: also from sides from which the
/// descriptors alone find nothing. Where points are too few, objects stand by themselves if they
/// are certain. Pure.
std::optional<Relocalization> relocalize_with_objects(const Frame& frame, const Map& map,
                                                      std::span<const SeenObject> seen,
                                                      const TrackingOptions& options,
                                                      std::uint64_t seed);

}  // namespace cairn
