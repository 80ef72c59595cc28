#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// A point of the map in a picture, in few bytes: what every frame leaves behind, so that it finds
/// its place in the final map.
struct Sighting {
  PointId point;
  std::int16_t x = 0, y = 0;  ///< where its row saw it (Frame::sighted_pixel), in 16ths of a pixel
  std::uint8_t row = 0;       ///< as in Frame; in the middle where all rows were seen at once
  std::uint8_t octave : 7 = 0;
  std::uint8_t aligned : 1 = 0;  ///< as in TrackedFrame
};

/// `points`: one a keypoint, invalid where it shows none. `aligned`: as in TrackedFrame; empty:
/// none.
std::vector<Sighting> sightings_of(const Frame& frame, std::span<const PointId> points,
                                   std::span<const char> aligned = {});

/// Where a camera (to world) was that saw the points of the map, as they are now, there. Nothing
/// where fewer than 30 agree.
///
/// `T_wc`: where it is looked for. `velocity`: of its motion meanwhile, as in Frame. `last_birth`:
/// sequence number of the newest keyframe at that time; points that are younger only have the name
/// of one that is gone.
std::optional<SE3> place(const Map& map, std::span<const Sighting> sightings,
                         std::uint32_t last_birth, const SE3& T_wc, const Vector6d& velocity);

}  // namespace cairn
