#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "cairn/features/features.h"
#include "cairn/features/image_pyramid.h"

namespace cairn {

struct OrbOptions {
  int count = 1000;        ///< keypoints a picture, about; 0 is for the caller to resolve
  int levels = 8;          ///< pyramid levels
  double scale = 1.2;      ///< size ratio between levels
  int threshold = 20;      ///< FAST: grey-level difference of a good corner
  int weak_threshold = 7;  ///< FAST: accepted where a region has no good corner
  bool subpixel = true;    ///< refine positions below the pixel
};

/// Extracts ORB features (Rublee et al. 2011): FAST corners over an image pyramid, spread over the
/// picture, oriented by the intensity centroid, described by rotated BRIEF. The result depends on
/// the picture and the options alone, not on the number of threads (all that the caller's TBB arena
/// or global_control grants). Descriptors are those of cv::ORB at the same place and angle. Not for
/// concurrent use: buffers are kept between calls.
class OrbExtractor {
 public:
  explicit OrbExtractor(const OrbOptions& options);
  ~OrbExtractor();

  /// `grey`: CV_8UC1, at least 64x64 (smaller ones have no features). `features` is overwritten,
  /// its memory reused; keypoints come level by level, finest first.
  void extract(const cv::Mat& grey, Features& features);

  /// Of the last picture; its pixels are overwritten with the next one's.
  const ImagePyramid& pyramid() const;

  const OrbOptions& options() const { return options_; }

 private:
  struct Buffers;
  OrbOptions options_;
  std::unique_ptr<Buffers> buffers_;
};

}  // namespace cairn
