#include "cairn/output/frames_csv.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <string>

#include "cairn/geometry/error.h"
#include "cairn/output/atomic_file.h"
#include "cairn/output/number_text.h"

namespace cairn {

void write_frames_csv(const std::filesystem::path& file, std::span<const FrameRecord> frames) {
  std::string text =
      "timestamp,state,matches,inliers,keyframe,extract_ms,predict_ms,local_map_ms,total_ms\n";
  for (const FrameRecord& frame : frames) {
    text += time_text(frame.timestamp) + ',' + std::string(to_string(frame.state)) + ',' +
            std::to_string(frame.matches) + ',' + std::to_string(frame.inliers) + ',' +
            (frame.keyframe ? '1' : '0');
    for (const double ms :
         {frame.extract_ms, frame.predict_ms, frame.local_map_ms, frame.total_ms}) {
      text += ',' + fixed_text(ms, 3);
    }
    text += '\n';
  }
  write_file(file, text);
}

std::vector<double> read_frame_times(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Kind::kInput, file.string() + why);
  };
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) refuse(": the file cannot be read; check that it is there");
  if (line.substr(0, line.find(',')) != "timestamp") {
    refuse(": its first column is not timestamp; take the frames.csv of a run");
  }
  std::vector<double> times;
  for (int number = 2; std::getline(stream, line); ++number) {
    double time = 0;
    const std::size_t end = std::min(line.find(','), line.size());
    const auto [stop, code] = std::from_chars(line.data(), line.data() + end, time);
    if (code != std::errc() || stop != line.data() + end || !std::isfinite(time)) {
      refuse(", line " + std::to_string(number) + ": no timestamp; mend or remove this line");
    }
    times.push_back(time);
  }
  return times;
}

}  // namespace cairn
