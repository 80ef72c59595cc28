#include "cairn/datasets/capture_source.h"

#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio/registry.hpp>

#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

template <typename Clock>
double seconds_now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

// The one back end that is meant where it is there, else whichever can: trying all is slow, noisy
// and leaks.
int back_end(cv::VideoCaptureAPIs wanted) {
  return cv::videoio_registry::hasBackend(wanted) ? wanted : cv::CAP_ANY;
}

void open_capture(cv::VideoCapture& capture, const std::string& name, bool live) {
  try {
    if (const auto index = parse_integer(name); live && index) {
      capture.open(int(*index), back_end(cv::CAP_V4L2));
    } else if (live && name.starts_with("/dev/")) {
      capture.open(name, back_end(cv::CAP_V4L2));
    } else {
      capture.open(name, back_end(cv::CAP_FFMPEG));  // knows the times of all containers
    }
  } catch (const cv::Exception&) {
    capture.release();
  }
  if (capture.isOpened()) return;
  const std::string sentence =
      live
          ? "camera " + name +
                ": it cannot be opened; check that it is plugged in, that no other program uses it "
                "and that you may read it (group video)"
          : name +
                ": the video cannot be opened; check that it plays elsewhere, or convert it to "
                "H.264 or MJPG";
  throw Error(Error::Kind::kInput, sentence);
}

}  // namespace

CaptureSource::CaptureSource(const std::string& name, Kind kind, bool colour)
    : name_(name), kind_(kind), colour_(colour) {
  open_capture(capture_, name, live());
  if (live()) capture_.set(cv::CAP_PROP_BUFFERSIZE, 1);  // an old frame is worth nothing
  const double fps = capture_.get(cv::CAP_PROP_FPS);
  if (std::isfinite(fps) && fps >= 1 && fps <= 1000) fps_ = fps;
  const double frames = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  if (!live() && std::isfinite(frames) && frames >= 1 && frames < 1e9) {
    promised_ = std::size_t(frames);
  }
  clock_offset_ =
      seconds_now<std::chrono::system_clock>() - seconds_now<std::chrono::steady_clock>();
  SourceFrame first;
  if (!read(first)) {
    throw Error(Error::Kind::kInput,
                (live() ? "camera " + name : name) + ": it gives no picture; " +
                    (live() ? "unplug it and plug it in again" : "check that the video plays"));
  }
  picture_size_ = first.image.size();
  first_ = std::move(first);
}

double CaptureSource::time_of_grabbed() {
  if (live()) return clock_offset_ + seconds_now<std::chrono::steady_clock>();
  const double time = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;
  if (count_ == 0) return std::isfinite(time) && time > 0 ? time : 0;
  // Some containers keep no times; then the frame rate tells.
  return std::isfinite(time) && time > last_time_ ? time : last_time_ + 1 / fps_;
}

bool CaptureSource::read(SourceFrame& frame) {
  try {
    if (!capture_.grab()) return false;
    last_time_ = time_of_grabbed();
    // A fresh Mat: the capture may reuse its own buffer for the next frame.
    cv::Mat picture;
    if (!capture_.retrieve(picture) || picture.empty()) return false;
    if (!colour_ && picture.channels() == 3) {
      cv::cvtColor(picture, frame.image, cv::COLOR_BGR2GRAY);
    } else {
      frame.image = picture.clone();
    }
  } catch (const cv::Exception&) {
    return false;
  }
  frame.timestamp = last_time_;
  frame.name = "frame " + std::to_string(count_++);
  frame.problem.clear();
  return true;
}

bool CaptureSource::next(SourceFrame& frame) {
  if (first_) {
    frame = std::move(*first_);
    first_.reset();
    return true;
  }
  if (ended_) return false;
  if (read(frame)) return true;
  ended_ = true;
  // Containers estimate their length; only a clear difference means a damaged or cut file.
  if (count_ + 2 + promised_ / 50 >= promised_) return false;
  frame = {};
  frame.timestamp = last_time_;
  frame.name = "frame " + std::to_string(count_);
  frame.problem = name_ + ": the video breaks off after " + std::to_string(count_) + " of " +
                  std::to_string(promised_) + " frames";
  return true;
}

std::optional<std::size_t> CaptureSource::size() const {
  if (promised_ == 0) return std::nullopt;
  return promised_;
}

}  // namespace cairn
