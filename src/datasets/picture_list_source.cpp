#include "cairn/datasets/picture_list_source.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cairn/datasets/picture_file.h"

namespace cairn {
namespace {

// The longest sequence of pictures whose times rise, by patience sorting (Fredman 1975).
std::vector<std::size_t> longest_rise(const std::vector<ListedPicture>& pictures) {
  constexpr std::size_t kNone = std::size_t(-1);
  std::vector<std::size_t> ends;  // of the rises of 1, 2, ... pictures, each as early as can be
  std::vector<std::size_t> before(pictures.size(), kNone);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double time = pictures[i].timestamp;
    if (!std::isfinite(time)) continue;
    const auto end = std::lower_bound(
        ends.begin(), ends.end(), time,
        [&](std::size_t other, double value) { return pictures[other].timestamp < value; });
    if (end != ends.begin()) before[i] = *std::prev(end);
    if (end == ends.end()) {
      ends.push_back(i);
    } else if (time < pictures[*end].timestamp) {
      *end = i;
    }
  }
  std::vector<std::size_t> rise;
  for (std::size_t i = ends.empty() ? kNone : ends.back(); i != kNone; i = before[i]) {
    rise.push_back(i);
  }
  std::reverse(rise.begin(), rise.end());
  return rise;
}

// One time far ahead would make all that follow it seem to go back.
void mark_times_ahead(std::vector<ListedPicture>& pictures) {
  std::size_t i = 0;
  for (const std::size_t next : longest_rise(pictures)) {
    const double limit = pictures[next].timestamp;
    for (; i < next; ++i) {
      ListedPicture& picture = pictures[i];
      if (!picture.problem.empty() || !(picture.timestamp > limit)) continue;
      char text[96];
      std::snprintf(text, sizeof text, ": its timestamp %.6f s is ahead of those that follow it",
                    picture.timestamp);
      picture.problem = picture.file.filename().string() + text;
    }
    i = next + 1;
  }
}

}  // namespace

PictureListSource::PictureListSource(std::vector<ListedPicture> pictures, bool colour)
    : pictures_(std::move(pictures)), colour_(colour) {
  mark_times_ahead(pictures_);
}

bool PictureListSource::next(SourceFrame& frame) {
  if (next_ == pictures_.size()) return false;
  const ListedPicture& picture = pictures_[next_++];
  frame.timestamp = picture.timestamp;
  frame.name = picture.file.filename().string();
  frame.problem = picture.problem;
  frame.image =
      frame.problem.empty() ? read_picture(picture.file, colour_, frame.problem) : cv::Mat();
  return true;
}

}  // namespace cairn
