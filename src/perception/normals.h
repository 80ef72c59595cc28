#pragma once

#include <opencv2/core.hpp>

#include "cairn/perception/organized_cloud.h"

namespace cairn {

struct NormalOptions {
  int radius_px = 3;           ///< of the square window that a plane is fitted in, grid pixels
  double max_step_sigmas = 3;  ///< neighbours further off in depth are of another surface, but
  double slope_share = 0.05;   ///< never this share of the depth a pixel off: a slanted one
  double min_share = 0.4;      ///< of the window that must be of the surface
};

/// Normals (CV_32FC3, camera frame, unit, towards the camera, 0 where unknown) of a depth map: at
/// each pixel a plane fitted to the neighbours of the same surface, in inverse depth.
cv::Mat_<cv::Vec3f> normals_from_depth(const cv::Mat_<cv::Vec3f>& rays,
                                       const cv::Mat_<float>& depth, const DepthNoise& noise,
                                       const NormalOptions& options = {});

}  // namespace cairn
