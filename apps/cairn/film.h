#pragma once

#include <filesystem>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/output/video_file.h"
#include "cairn/system/slam.h"

namespace cairn::app {

/// The annotated video, and a strip of stills of it for those who cannot play it.
class Film {
 public:
  Film(const std::filesystem::path& folder, const Camera& camera, double fps);

  /// A frame with the planes that were detected in it, or, where none were, with those of the map;
  /// with the objects of the map, and thinly with the boxes that were detected. The map may be
  /// null.
  void add(const cv::Mat& image, const FrameResult& result, const MapView* map);
  /// Throws Error(kOutput).
  void finish();

 private:
  void keep_still(const cv::Mat& picture);

  std::filesystem::path folder_;
  Camera camera_;
  VideoFile video_;
  std::vector<cv::Mat> stills_;
  std::size_t count_ = 0, stride_ = 1;
};

}  // namespace cairn::app
