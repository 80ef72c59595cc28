#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/perception/detections.h"
#include "cairn/perception/plane_detector.h"

namespace cairn {

struct ObjectDetectorOptions {
  double min_score = 0;              ///< 0: the card's own
  std::vector<std::string> classes;  ///< kept; empty: all
};

/// Finds things in single pictures. Not for several threads at once; the result follows from the
/// input alone. Boxes are in the pixels of the input's picture, lens distortion included.
class ObjectDetector {
 public:
  virtual ~ObjectDetector() = default;
  /// Into `frame.objects`, by falling score; other parts of the frame stay. A picture that cannot
  /// be used gives none and a `problem`; it does not throw.
  virtual void detect(const PerceptionInput& input, DetectedFrame& frame) = 0;
};

}  // namespace cairn
