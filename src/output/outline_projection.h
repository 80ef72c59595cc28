#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// Where a flat polygon of the world shows in a picture of the camera: pixels, with the bend of the
/// lens, corner after corner. What is behind the camera or beyond the picture is cut off, a little
/// outside of the picture, so that no cut is seen. Empty where nothing is in sight.
std::vector<cv::Point2f> project_outline(std::span<const Eigen::Vector3d> outline, const SE3& T_cw,
                                         const Camera& camera);

}  // namespace cairn
