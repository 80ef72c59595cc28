#pragma once

#include <filesystem>

#include "cairn/perception/object_detector.h"
#include "cairn/perception/recorded_frames.h"

namespace cairn {

/// Gives back the objects that a file (perception.jsonl) has of a picture, by its time.
class RecordedObjectDetector : public ObjectDetector {
 public:
  /// Throws Error(kInput) as RecordedFrames does. `max_difference_s`: RecordedFrames.
  explicit RecordedObjectDetector(const std::filesystem::path& file,
                                  const ObjectDetectorOptions& options = {},
                                  double max_difference_s = 0.005);
  /// Nothing, without a problem, where no frame is near enough. Only the picture's size is looked
  /// at: boxes are cut off at its border, and masks of another size are left out.
  void detect(const PerceptionInput& input, DetectedFrame& frame) override;
  /// How many boxes lay wholly outside of their picture, and were left out for it.
  int outside_count() const { return outside_count_; }

 private:
  RecordedFrames frames_;
  ObjectDetectorOptions options_;
  int outside_count_ = 0;
};

}  // namespace cairn
