#pragma once

#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// What saw a point: any keypoint, or only a corner (see Frame::corners).
enum class SeenBy : std::uint8_t { kKeypoints, kCorners };

/// Points that at least one of the keyframes sees, each once, in order of ids.
std::vector<PointId> points_seen_from(const Map& map, std::span<const KeyframeId> keyframes,
                                      SeenBy by = SeenBy::kKeypoints);

}  // namespace cairn
