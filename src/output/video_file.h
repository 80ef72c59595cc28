#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>

#include "cairn/output/atomic_file.h"

namespace cairn {

/// A video that appears under its name when it is complete: MPEG-4 for .mp4, Motion JPEG for .avi.
class VideoFile {
 public:
  /// Throws Error(kUsage) for another ending.
  VideoFile(const std::filesystem::path& file, double fps);
  ~VideoFile();

  /// `picture`: CV_8UC3 of the size of the first. Throws Error(kOutput) if it cannot be begun.
  void write(const cv::Mat& picture);
  /// Closes and names the file; nothing happens if there was no picture. Throws Error(kOutput) if
  /// it did not reach the disk as a whole.
  void finish();

 private:
  std::filesystem::path file_;
  PendingFile pending_;
  double fps_;
  cv::VideoWriter writer_;
  cv::Size size_;
};

}  // namespace cairn
