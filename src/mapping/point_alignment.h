#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// After a keyframe was taken in, with its new points: says what new points look like, and moves
/// the keypoints that have come to see a point, in this keyframe and in those whose pictures are
/// still at hand, to where these look as the point does.
void align_points(Map& map, KeyframeId newest);

}  // namespace cairn
