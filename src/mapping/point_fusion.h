#pragma once

#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// Projects points into a keyframe. Where one meets a keypoint that looks the same, the keypoint
/// becomes an observation of it, or, if it has a point already, the two become one (the one that is
/// seen more often stays), unless most of what saw the other could not have seen it there.
/// `radius`: pixels at octave 0. Returns how many links or merges were made.
int fuse_into(Map& map, KeyframeId keyframe, std::span<const PointId> points, double radius);

/// Fusion between a keyframe and its neighbourhood, both ways.
int fuse_neighbourhood(Map& map, KeyframeId keyframe, int neighbours);

/// Fusion of every keyframe with all points of the map that it should see.
int fuse_everywhere(Map& map);

}  // namespace cairn
