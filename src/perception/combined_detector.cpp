#include "cairn/perception/combined_detector.h"

#include <utility>

namespace cairn {

CombinedDetector::CombinedDetector(std::unique_ptr<PlaneDetector> planes,
                                   std::unique_ptr<ObjectDetector> objects)
    : planes_(std::move(planes)), objects_(std::move(objects)) {}

DetectedFrame CombinedDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame;
  if (planes_ != nullptr) frame = planes_->detect(input);
  frame.timestamp = input.timestamp;
  frame.objects.clear();
  if (objects_ == nullptr) return frame;
  const std::string of_planes = std::exchange(frame.problem, "");
  objects_->detect(input, frame);
  const bool both = !of_planes.empty() && !frame.problem.empty();
  frame.problem = of_planes + (both ? "; " : "") + frame.problem;
  return frame;
}

}  // namespace cairn
