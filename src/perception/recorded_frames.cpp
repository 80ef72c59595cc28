#include "cairn/perception/recorded_frames.h"

#include <algorithm>
#include <cmath>

#include "cairn/perception/recorded_perception.h"

namespace cairn {

RecordedFrames::RecordedFrames(const std::filesystem::path& file, double max_difference_s)
    : frames_(read_recorded_perception(file)), max_difference_s_(max_difference_s) {
  std::stable_sort(frames_.begin(), frames_.end(),
                   [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
}

const DetectedFrame* RecordedFrames::at(double timestamp) const {
  const auto nearer = [&](const DetectedFrame& a, const DetectedFrame& b) {
    return std::abs(a.timestamp - timestamp) < std::abs(b.timestamp - timestamp);
  };
  const auto after = std::lower_bound(
      frames_.begin(), frames_.end(), timestamp,
      [](const DetectedFrame& frame, double time) { return frame.timestamp < time; });
  const auto first = after == frames_.begin() ? after : after - 1;
  const auto last = after == frames_.end() ? after : after + 1;
  const auto best = std::min_element(first, last, nearer);
  if (best == last || std::abs(best->timestamp - timestamp) > max_difference_s_) return nullptr;
  return &*best;
}

}  // namespace cairn
