#include "cairn/perception/recorded_plane_detector.h"

namespace cairn {

RecordedPlaneDetector::RecordedPlaneDetector(const std::filesystem::path& file,
                                             double max_difference_s)
    : frames_(file, max_difference_s) {}

DetectedFrame RecordedPlaneDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame = frames_.at(input.timestamp).value_or(DetectedFrame());
  frame.timestamp = input.timestamp;
  return frame;
}

}  // namespace cairn
