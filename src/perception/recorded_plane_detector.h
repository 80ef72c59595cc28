#pragma once

#include <filesystem>

#include "cairn/perception/plane_detector.h"
#include "cairn/perception/recorded_frames.h"

namespace cairn {

/// Gives back what a file (perception.jsonl) says of a picture, objects included, by its time.
class RecordedPlaneDetector : public PlaneDetector {
 public:
  /// Throws Error(kInput) as RecordedFrames does. A picture takes the nearest frame not
  /// further than `max_difference_s`, which must be below half the time between pictures.
  explicit RecordedPlaneDetector(const std::filesystem::path& file,
                                 double max_difference_s = 0.005);
  /// Nothing is detected, without a problem, where no frame is near enough. The picture is not
  /// looked at.
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  RecordedFrames frames_;
};

}  // namespace cairn
