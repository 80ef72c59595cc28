#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace cairn {

/// Gaussian of sigma 2 pixels on 7x7, what BRIEF's tests read (Calonder et al. 2010); the border is
/// mirrored without repeating its pixel. Integer arithmetic, within 2 grey levels of
/// cv::GaussianBlur. Buffers are kept between calls.
class GaussianBlur7 {
 public:
  /// Fills rows [first_row, last_row) of `blurred` from `image`. Both CV_8UC1, of one size, at
  /// least 4x4.
  void blur(const cv::Mat& image, int first_row, int last_row, cv::Mat& blurred);

 private:
  std::vector<std::uint8_t> buffer_;
};

}  // namespace cairn
