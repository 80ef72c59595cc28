#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// Finds of each keyframe that a rolling shutter took how it moved meanwhile, as its points show
/// it, and moves its keypoints to where an instant shutter would have seen them. Tracking only
/// knows how the camera moved since the frame before.
void find_motions(Map& map);

}  // namespace cairn
