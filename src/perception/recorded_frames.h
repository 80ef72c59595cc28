#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cairn/perception/detections.h"

namespace cairn {

/// The frames of a file (perception.jsonl) by their time. It holds their lines, as masks of a film
/// would fill the memory.
class RecordedFrames {
 public:
  /// Reads all lines once, so that a wrong one is known at start-up; empty ones are passed over.
  /// Throws Error(kInput) if the file cannot be read, and as parse_json_line does.
  /// `max_difference_s` must be below half the time between pictures.
  explicit RecordedFrames(const std::filesystem::path& file, double max_difference_s = 0.005);
  /// The nearest in time; none where none is near enough.
  std::optional<DetectedFrame> at(double timestamp) const;

 private:
  struct Line {
    double timestamp;
    std::string text;
  };
  std::vector<Line> lines_;  // by time
  double max_difference_s_;
};

}  // namespace cairn
