#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "cairn/system/slam.h"

namespace cairn {

/// Frames that show nothing, as when a hand covers the lens.
struct Blackout {
  int begin = 0, end = 0;  ///< frame numbers, the end excluded

  cv::Mat operator()(int frame, const cv::Mat& picture) const {
    if (frame < begin || frame >= end) return picture;
    return cv::Mat::zeros(picture.size(), picture.type());
  }
};

/// Losses that ended.
inline int recoveries(const SlamResult& result) {
  int count = 0;
  for (const SlamResult::Gap& gap : result.gaps) count += std::isfinite(gap.recovered);
  return count;
}

}  // namespace cairn
