#pragma once

// The datasets room: what is on disk or comes from a camera, as frames with timestamps, a camera
// and a ground truth. It knows layouts and file formats; it must not know tracking or maps.

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace cairn {

/// One picture of the moving camera.
struct SourceFrame {
  /// Seconds. Where the input gives no usable time (see `problem`), the time of the frame before.
  double timestamp = 0;
  cv::Mat image;     ///< CV_8UC1 or CV_8UC3 (BGR)
  std::string name;  ///< file name, or number in the video
  /// Not empty: why this frame cannot be used, with the name of the file; the image is empty then.
  std::string problem;
  /// Measured, where that was asked for: CV_32F, metres along the optical axis, in the pixels of
  /// the image, 0 where unknown. Else empty.
  cv::Mat depth{};
  /// Not empty: why there is no depth although it was asked for. The frame can be used without.
  std::string depth_problem{};
};

/// A stream of frames. Not for concurrent use.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame, or false at the end. A frame that cannot be used is no end: it comes with its
  /// `problem`.
  virtual bool next(SourceFrame& frame) = 0;
  /// Frames in all, where that is known before the end.
  virtual std::optional<std::size_t> size() const = 0;
  /// True if frames come at their own time and are lost when nobody takes them.
  virtual bool live() const { return false; }
};

}  // namespace cairn
