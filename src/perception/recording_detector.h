#pragma once

#include <filesystem>
#include <fstream>
#include <memory>

#include "cairn/perception/plane_detector.h"

namespace cairn {

/// Another detector, all of whose answers are written down, a line each (recorded_perception.h),
/// for `recorded` to read.
class RecordingDetector : public PlaneDetector {
 public:
  /// Throws Error(kOutput) if the file cannot be written.
  RecordingDetector(std::unique_ptr<PlaneDetector> detector, const std::filesystem::path& file);
  /// Throws Error(kOutput) if the disk is full.
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  std::unique_ptr<PlaneDetector> detector_;
  std::filesystem::path path_;
  std::ofstream file_;
};

}  // namespace cairn
