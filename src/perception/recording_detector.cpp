#include "cairn/perception/recording_detector.h"

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_perception.h"

namespace cairn {

RecordingDetector::RecordingDetector(std::unique_ptr<PlaneDetector> detector,
                                     const std::filesystem::path& file)
    : detector_(std::move(detector)), path_(file), file_(file) {
  if (!file_) {
    throw Error(Error::Kind::kOutput,
                path_.string() + ": cannot be written; give a file in a folder that can");
  }
}

DetectedFrame RecordingDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame = detector_->detect(input);
  frame.timestamp = input.timestamp;
  file_ << to_json_line(frame) << '\n' << std::flush;
  if (!file_) {
    throw Error(Error::Kind::kOutput,
                path_.string() + ": cannot be written any more; is the disk full?");
  }
  return frame;
}

}  // namespace cairn
