#pragma once

#include <opencv2/core.hpp>

#include "cairn/geometry/box.h"

namespace cairn {

/// All of a picture of this size: pixel centres at integers, so from -0.5.
inline Box2 picture_box(const cv::Size& size) {
  return {-0.5, -0.5, size.width - 0.5, size.height - 0.5};
}

}  // namespace cairn
