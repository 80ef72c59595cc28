#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// A point seen along two rays.
struct TwoRayPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< first camera frame, units of the baseline
  double depth1 = 0, depth2 = 0;                    ///< along the rays; negative behind a camera
  double parallax = 0;                              ///< angle between the corrected rays, radians
  /// In front of both cameras, at a finite depth.
  bool in_front() const { return depth1 > 0 && depth2 > 0; }
};

/// The point that minimises sin²θ1 + sin²θ2 of the angles to the two rays, in closed form: both
/// rays are turned into the one epipolar plane that is nearest to them, where they meet exactly
/// (Lee and Civera, "Closed-form optimal two-view triangulation based on angular errors", ICCV
/// 2019, the L2 case). No memory is allocated. `ray1` is in the first camera frame, `ray2` in the
/// second, any positive length. Parallel rays give depths of zero.
TwoRayPoint triangulate_two_rays(const SE3& T_21, const Eigen::Vector3d& ray1,
                                 const Eigen::Vector3d& ray2);

/// The same for many points of one pair of cameras: `R_21` and `t_21` are computed once.
TwoRayPoint triangulate_two_rays(const Eigen::Matrix3d& R_21, const Eigen::Vector3d& t_21,
                                 const Eigen::Vector3d& ray1, const Eigen::Vector3d& ray2);

}  // namespace cairn
