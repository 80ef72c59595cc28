#include "cairn/perception/recorded_object_detector.h"

#include <algorithm>

#include "cairn/perception/picture_box.h"

namespace cairn {

RecordedObjectDetector::RecordedObjectDetector(const std::filesystem::path& file,
                                               const ObjectDetectorOptions& options,
                                               double max_difference_s)
    : frames_(file, max_difference_s), options_(options) {}

void RecordedObjectDetector::detect(const PerceptionInput& input, DetectedFrame& frame) {
  frame.objects.clear();
  if (input.bgr.empty()) {
    frame.problem = "the picture is empty";
    return;
  }
  const std::optional<DetectedFrame> recorded = frames_.at(input.timestamp);
  if (!recorded) return;
  const std::vector<std::string>& classes = options_.classes;
  for (DetectedObject object : recorded->objects) {
    const bool wanted = classes.empty() || std::find(classes.begin(), classes.end(),
                                                     object.class_name) != classes.end();
    if (!wanted || object.score < options_.min_score) continue;
    object.box = object.box.clipped(picture_box(input.bgr.size()));
    if (!object.box.valid()) {
      ++outside_count_;
      continue;
    }
    if (object.mask.size() != input.bgr.size()) object.mask.release();
    frame.objects.push_back(object);
  }
  std::stable_sort(frame.objects.begin(), frame.objects.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
}

}  // namespace cairn
