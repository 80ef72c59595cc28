#include "cairn/datasets/checked_source.h"

#include <cmath>
#include <cstdio>

#include "cairn/datasets/picture_file.h"

namespace cairn {
namespace {

std::string in_seconds(double t) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6f s", t);
  return text;
}

}  // namespace

CheckedSource::CheckedSource(std::unique_ptr<FrameSource> source, cv::Size size)
    : source_(std::move(source)), picture_size_(size) {}

bool CheckedSource::next(SourceFrame& frame) {
  if (!source_->next(frame)) return false;
  if (!std::isfinite(frame.timestamp)) {
    if (frame.problem.empty()) frame.problem = frame.name + ": its timestamp is not a number";
    frame.timestamp = last_;
  }
  if (frame.problem.empty()) {
    if (last_good_ && frame.timestamp == *last_good_) {
      frame.problem = frame.name + ": its timestamp " + in_seconds(frame.timestamp) +
                      " repeats that of the frame before";
    } else if (last_good_ && frame.timestamp < *last_good_) {
      frame.problem = frame.name + ": its timestamp " + in_seconds(frame.timestamp) +
                      " goes back behind " + in_seconds(*last_good_);
    } else if (frame.image.size() != picture_size_) {
      frame.problem = frame.name + ": the picture is " + in_pixels(frame.image.size()) +
                      ", but the first one is " + in_pixels(picture_size_);
    }
  }
  if (frame.problem.empty()) {
    last_good_ = frame.timestamp;
  } else {
    frame.image.release();
    frame.depth.release();
  }
  last_ = frame.timestamp;
  return true;
}

}  // namespace cairn
