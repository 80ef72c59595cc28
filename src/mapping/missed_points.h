#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// Looks in the picture of a keyframe for points that its neighbours see and that it should see,
/// too, but that no corner was found for, or one that matched none: where the picture looks as a
/// point does, near where it should be, the keyframe sees it from now on, by the corner that is
/// there or by a keypoint of its own (see Frame::corners). Corners are found again in every other
/// picture or so: points are seen for longer, and what drifts between their views drifts less.
/// Returns how many there were; none where the picture is not at hand.
int find_missed_points(Map& map, KeyframeId id);

/// Of all but the newest keyframes: looks in their pictures once more, as more points are known by
/// now than when they were new, and lets the pictures go.
void look_back(Map& map);

}  // namespace cairn
