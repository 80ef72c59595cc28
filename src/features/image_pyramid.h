#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace cairn {

/// A picture at sizes that shrink by a constant ratio, each interpolated from the one before.
/// Memory is kept between pictures of one size.
class ImagePyramid {
 public:
  /// Refers to `grey` (CV_8UC1, not copied) as level 0; the others are allocated, not computed.
  void reset(const cv::Mat& grey, int levels, double scale);

  /// Fills a level from the one below it.
  void compute(int level);

  int levels() const { return static_cast<int>(levels_.size()); }
  const cv::Mat& operator[](int level) const { return levels_[level]; }

  /// Pixels of level 0 a pixel of this level, along x and y; they differ a little, as sizes are
  /// whole numbers. Pixel centres are at integers in every level, thus x0 = (x + 0.5) * ratio.x -
  /// 0.5.
  cv::Point2f ratio(int level) const { return ratios_[level]; }
  cv::Point2f to_base(cv::Point2f point, int level) const {
    return {(point.x + 0.5F) * ratios_[level].x - 0.5F, (point.y + 0.5F) * ratios_[level].y - 0.5F};
  }
  cv::Point2f from_base(cv::Point2f point, int level) const {
    return {(point.x + 0.5F) / ratios_[level].x - 0.5F, (point.y + 0.5F) / ratios_[level].y - 0.5F};
  }

  /// A copy that shares no pixels; plain copies do.
  ImagePyramid clone() const;

 private:
  std::vector<cv::Mat> levels_;
  std::vector<cv::Point2f> ratios_;
};

}  // namespace cairn
