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
  int inliers = 0;
};

/// Finds a frame in the map: descriptors against each candidate keyframe (by appearance, the
/// likeliest first), resection by P3P within RANSAC, then the points around that keyframe by
/// projection. Pure: it changes nothing. `seed` steers the random samples.
std::optional<Relocalization> relocalize(const Frame& frame, const Map& map,
                                         std::span<const KeyframeId> candidates,
                                         const TrackingOptions& options, std::uint64_t seed);

}  // namespace cairn
