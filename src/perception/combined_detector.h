#pragma once

#include <memory>

#include "cairn/perception/object_detector.h"
#include "cairn/perception/plane_detector.h"

namespace cairn {

/// Planes of one detector and objects of another, in one frame.
class CombinedDetector : public PlaneDetector {
 public:
  /// Either may be null: then there are no planes and no depth, or no objects.
  CombinedDetector(std::unique_ptr<PlaneDetector> planes, std::unique_ptr<ObjectDetector> objects);
  /// Objects that the plane detector knows of (a recording's) are left out. The problems of both
  /// are joined; one does not keep the other from its answer.
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  std::unique_ptr<PlaneDetector> planes_;
  std::unique_ptr<ObjectDetector> objects_;
};

}  // namespace cairn
