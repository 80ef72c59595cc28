#pragma once

#include <span>

#include "cairn/map/map.h"

namespace cairn {

/// How a keyframe's camera moved around the time of its picture.
struct KeyframeMotion {
  KeyframeId keyframe;
  Vector6d velocity;  ///< tangent vector in its own frame, a second
};

/// Moves the keypoints of keyframes that a rolling shutter took to where an instant one would have
/// seen them, should they have moved so. Tracking only knows how the camera moved since the frame
/// before; with the frames after it one knows better, and how long the readout takes, which noise
/// in the motion makes look shorter.
void set_motions(Map& map, std::span<const KeyframeMotion> motions);

/// Finds of each keyframe that a rolling shutter took how it moved meanwhile, as its points show
/// it, and moves its keypoints likewise.
void find_motions(Map& map);

}  // namespace cairn
