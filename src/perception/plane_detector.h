#pragma once

#include <opencv2/core.hpp>

#include "cairn/perception/detections.h"

namespace cairn {

/// What a plane detector looks at.
struct PerceptionInput {
  cv::Mat bgr;    ///< CV_8UC3 or CV_8U, as the camera gave it, lens distortion included
  cv::Mat depth;  ///< CV_32F, metres along the optical axis, registered, of the picture's shape, 0
                  ///< where unknown; empty without such a sensor
  double timestamp = 0;  ///< seconds
};

/// Finds planes in single pictures. Not for several threads at once; the result follows from the
/// input alone. Masks are in the pixels of the input's picture, planes in the camera frame.
class PlaneDetector {
 public:
  virtual ~PlaneDetector() = default;
  /// By falling score. A picture that cannot be used gives no planes and a `problem`; it does not
  /// throw.
  virtual DetectedFrame detect(const PerceptionInput& input) = 0;
};

}  // namespace cairn
