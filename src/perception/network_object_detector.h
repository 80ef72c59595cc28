#pragma once

#include "cairn/perception/network.h"
#include "cairn/perception/object_detector.h"

namespace cairn {

/// Objects of a network that a card of kind objects describes.
class NetworkObjectDetector : public ObjectDetector {
 public:
  /// Throws Error as Network does; kUsage for a card of another kind and for classes that are none
  /// of its labels.
  explicit NetworkObjectDetector(const NetworkCard& card,
                                 const ObjectDetectorOptions& options = {});
  /// Boxes are cut off at the picture's border; what has no area then is left out.
  void detect(const PerceptionInput& input, DetectedFrame& frame) override;

 private:
  Network network_;
  double min_score_;
  std::vector<bool> wanted_;  // by label
};

}  // namespace cairn
