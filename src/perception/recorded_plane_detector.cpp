#include "cairn/perception/recorded_plane_detector.h"

#include <algorithm>
#include <cmath>

#include "cairn/perception/recorded_perception.h"

namespace cairn {

RecordedPlaneDetector::RecordedPlaneDetector(const std::filesystem::path& file,
                                             double max_difference_s)
    : frames_(read_recorded_perception(file)), max_difference_s_(max_difference_s) {
  std::stable_sort(frames_.begin(), frames_.end(),
                   [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
}

DetectedFrame RecordedPlaneDetector::detect(const PerceptionInput& input) {
  const auto nearer = [&](const DetectedFrame& a, const DetectedFrame& b) {
    return std::abs(a.timestamp - input.timestamp) < std::abs(b.timestamp - input.timestamp);
  };
  const auto after = std::lower_bound(
      frames_.begin(), frames_.end(), input.timestamp,
      [](const DetectedFrame& frame, double time) { return frame.timestamp < time; });
  const auto first = after == frames_.begin() ? after : after - 1;
  const auto last = after == frames_.end() ? after : after + 1;
  const auto best = std::min_element(first, last, nearer);
  DetectedFrame frame;
  if (best != last && std::abs(best->timestamp - input.timestamp) <= max_difference_s_) {
    frame = *best;
  }
  frame.timestamp = input.timestamp;
  return frame;
}

}  // namespace cairn
