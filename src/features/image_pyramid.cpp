#include "cairn/features/image_pyramid.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cairn {

void ImagePyramid::reset(const cv::Mat& grey, int levels, double scale) {
  levels_.resize(levels);
  ratios_.resize(levels);
  levels_[0] = grey;
  ratios_[0] = {1, 1};
  for (int level = 1; level < levels; ++level) {
    const double shrink = std::pow(scale, -level);
    const int width = std::max(1, static_cast<int>(std::lround(grey.cols * shrink)));
    const int height = std::max(1, static_cast<int>(std::lround(grey.rows * shrink)));
    levels_[level].create(height, width, CV_8UC1);
    ratios_[level] = {static_cast<float>(double(grey.cols) / width),
                      static_cast<float>(double(grey.rows) / height)};
  }
}

void ImagePyramid::compute(int level) {
  cv::Mat& target = levels_[level];
  cv::resize(levels_[level - 1], target, target.size(), 0, 0, cv::INTER_LINEAR);
}

ImagePyramid ImagePyramid::clone() const {
  ImagePyramid copy;
  for (const cv::Mat& level : levels_) copy.levels_.push_back(level.clone());
  copy.ratios_ = ratios_;
  return copy;
}

}  // namespace cairn
