#pragma once

#include "cairn/geometry/se3.h"
#include "cairn/map/frame.h"

namespace cairn {

/// Where a point would show to a camera, given how it was seen before: nothing if it lies outside
/// of the picture, out of the range of scales, or is seen from a side it was never seen from.
struct Visibility {
  bool visible = false;
  Eigen::Vector2d pixel;
  int octave = 0;     ///< predicted
  double cosine = 1;  ///< between the viewing ray and the mean of earlier ones
};
Visibility predict_visibility(const View& view, const SE3& T_cw, const Eigen::Vector3d& camera_w,
                              const Eigen::Vector3d& position, const Eigen::Vector3f& normal,
                              float base_distance);

}  // namespace cairn
