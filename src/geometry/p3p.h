#pragma once

#include <Eigen/Core>
#include <array>

#include "cairn/geometry/se3.h"

namespace cairn {

/// The poses, up to four, that a minimal sample admits.
struct PoseCandidates {
  std::array<SE3, 4> poses;  ///< T_cw
  int count = 0;
};

/// The poses that see three world points along three rays (camera frame, any positive length), all
/// points in front along their rays: Persson and Nordberg, "Lambda Twist: an accurate fast robust
/// perspective three point (P3P) solver" (ECCV 2018). Points on a line, or input that is not
/// finite, give none.
PoseCandidates p3p(const std::array<Eigen::Vector3d, 3>& rays,
                   const std::array<Eigen::Vector3d, 3>& points_w);

}  // namespace cairn
