#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// Puts the pictures of a depth camera into the pixels of the colour camera beside it. Each depth
/// pixel fills all that it covers there, so that coarse depth leaves no holes; of several the
/// nearest one is seen.
class DepthRegistration {
 public:
  /// `T_color_depth`: depth camera to colour camera, metres.
  DepthRegistration(const Camera& colour, const Camera& depth, const SE3& T_color_depth);

  /// `metres`: CV_32F along the axis of the depth camera, of its size, 0 where unknown. Returns the
  /// same along the axis of the colour camera, of the colour camera's size.
  cv::Mat_<float> operator()(const cv::Mat_<float>& metres) const;

 private:
  Eigen::Vector3d corner(int column, int row) const;

  Camera colour_;
  cv::Size size_;  // of the depth pictures
  SE3 T_color_depth_;
  // Of the corners between depth pixels, one more each way than pixels: at depth 1, in the frame of
  // the colour camera but for the translation.
  std::vector<Eigen::Vector3d> rays_;
};

}  // namespace cairn
