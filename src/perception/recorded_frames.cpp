#include "cairn/perception/recorded_frames.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "cairn/geometry/error.h"
#include "cairn/perception/recorded_perception.h"

namespace cairn {

RecordedFrames::RecordedFrames(const std::filesystem::path& file, double max_difference_s)
    : max_difference_s_(max_difference_s) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw Error(Error::Kind::kInput, file.string() + ": cannot be read as recorded detections");
  }
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = file.string() + ", line " + std::to_string(number);
    const double timestamp = parse_json_line(text, where).timestamp;
    lines_.push_back({timestamp, text});
  }
  std::stable_sort(lines_.begin(), lines_.end(),
                   [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
}

std::optional<DetectedFrame> RecordedFrames::at(double timestamp) const {
  const auto nearer = [&](const Line& a, const Line& b) {
    return std::abs(a.timestamp - timestamp) < std::abs(b.timestamp - timestamp);
  };
  const auto after =
      std::lower_bound(lines_.begin(), lines_.end(), timestamp,
                       [](const Line& line, double time) { return line.timestamp < time; });
  const auto first = after == lines_.begin() ? after : after - 1;
  const auto last = after == lines_.end() ? after : after + 1;
  const auto best = std::min_element(first, last, nearer);
  if (best == last || std::abs(best->timestamp - timestamp) > max_difference_s_) return {};
  return parse_json_line(best->text, "recorded detections");
}

}  // namespace cairn
