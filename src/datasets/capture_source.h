#pragma once

#include <chrono>
#include <opencv2/videoio.hpp>
#include <string>

#include "cairn/datasets/frame_source.h"

namespace cairn {

/// Frames of a video file or of a live camera.
class CaptureSource : public FrameSource {
 public:
  enum class Kind {
    kFile,  ///< timestamps of the container, or counted by its frame rate
    kLive,  ///< timestamps of the clock at the moment the frame arrived, Unix time
  };

  /// `name`: the number of a camera ("0") or anything that cv::VideoCapture opens (a file, a
  /// device, a URL). Throws Error(kInput) if it cannot be opened or gives no first picture.
  CaptureSource(const std::string& name, Kind kind, bool colour);

  bool next(SourceFrame& frame) override;
  std::optional<std::size_t> size() const override;
  bool live() const override { return kind_ == Kind::kLive; }

  cv::Size picture_size() const { return picture_size_; }
  /// Frames a second as the device or the container says, or 30.
  double fps() const { return fps_; }

 private:
  bool read(SourceFrame& frame);
  double time_of_grabbed();

  cv::VideoCapture capture_;
  std::string name_;
  Kind kind_;
  bool colour_;
  cv::Size picture_size_;
  double fps_ = 30;
  std::size_t promised_ = 0;  // frames that the container claims; 0 if it does not say
  std::size_t count_ = 0;     // frames read
  bool ended_ = false;
  double last_time_ = 0;
  std::optional<SourceFrame> first_;  // read on opening, to know the size
  double clock_offset_ = 0;           // from the steady clock to Unix time, seconds
};

}  // namespace cairn
