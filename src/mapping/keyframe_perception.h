#pragma once

#include <memory>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/map/map.h"
#include "cairn/perception/detections.h"

namespace cairn {

/// What perception says of a keyframe's picture, reduced to its keypoints: no picture is kept.
/// Lengths are the detector's metres.
struct KeyframePerception {
  std::shared_ptr<const Frame> frame;  ///< which the keyframe holds
  double sigma_scale = 0;              ///< of the logarithm of the scale of all lengths
  std::vector<float> depth;            ///< predicted, one a keypoint; 0: unknown
  DepthRange range;                    ///< of the whole picture's
  std::vector<SeenPlane> planes;
  std::vector<SeenObject> objects;
  double milliseconds = 0;  ///< that it took
};

/// `camera`: with the lens, as the picture was taken. Where a detector gives no depth, that of the
/// planes serves. What cannot be (not finite, no area, planes not in front of the camera or without
/// a mask) is left out.
KeyframePerception summarize_perception(const DetectedFrame& detected,
                                        std::shared_ptr<const Frame> frame, const Camera& camera,
                                        const View& view);

}  // namespace cairn
