#pragma once

#include <opencv2/core.hpp>
#include <span>

#include "cairn/perception/detections.h"

namespace cairn {

/// Where a picture shows things that hang on a wall, as posters and windows do: parts of it that
/// are of no detected plane and border on that of one upright surface alone. What stands before a
/// wall borders on what it stands on, too.
///
/// Returns CV_32S of the size of the masks: the index of that plane in `planes`, or -1. Planes
/// whose masks are of another size or type are passed over.
cv::Mat_<int> hung_things(std::span<const DetectedPlane> planes, cv::Size size);

}  // namespace cairn
