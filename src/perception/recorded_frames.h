#pragma once

#include <filesystem>
#include <vector>

#include "cairn/perception/detections.h"

namespace cairn {

/// The frames of a file (perception.jsonl) by their time.
class RecordedFrames {
 public:
  /// Throws Error(kInput) as read_recorded_perception does. `max_difference_s` must be below half
  /// the time between pictures.
  explicit RecordedFrames(const std::filesystem::path& file, double max_difference_s = 0.005);
  /// The nearest in time; null where none is near enough.
  const DetectedFrame* at(double timestamp) const;

 private:
  std::vector<DetectedFrame> frames_;  // by time
  double max_difference_s_;
};

}  // namespace cairn
