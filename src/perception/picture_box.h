#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/box.h"

namespace cairn {

/// All of a picture of this size: pixel centres at integers, so from -0.5.
inline Box2 picture_box(const cv::Size& size) {
  return {-0.5, -0.5, size.width - 0.5, size.height - 0.5};
}

/// What of its picture a mask covers, and so many pixels around it.
inline cv::Rect surroundings(const cv::Mat& mask, int margin) {
  const cv::Rect box = cv::boundingRect(mask);
  return cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
         cv::Rect({}, mask.size());
}

}  // namespace cairn
