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

/// One observation for triangulate(): a pixel of the ideal pinhole camera.
struct TriangulationView {
  SE3 T_cw;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1;
};

struct TriangulationOptions {
  double min_parallax_deg = 0.5;
  double max_error_sigmas = 2.4477;  ///< sqrt(5.99): chi-square, 95 %, two degrees of freedom
  int iterations = 8;                ///< of Gauss-Newton, at most
};

/// A triangulated point, or the cause why there is none. The numbers are filled in as far as the
/// point came.
struct Triangulation {
  enum class Cause {
    kNone,         ///< the point is usable
    kTooFewViews,  ///< fewer than two
    kNotFinite,    ///< a number of the input is not finite, or all rays are parallel
    kBehindCamera,
    kSmallParallax,
    kLargeError,  ///< a view's reprojection error is over the gate
  };
  Cause cause = Cause::kTooFewViews;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< world
  double parallax_deg = 0;                          ///< the largest angle between two rays
  double max_error_sigmas = 0;                      ///< the worst view's reprojection error
  double min_depth = 0, max_depth = 0;              ///< z in the cameras

  bool usable() const { return cause == Cause::kNone; }
};

/// The cause as words for people.
std::string describe(Triangulation::Cause cause);

/// The world point that minimises the squared reprojection errors, in sigmas, over all views: the
/// direct linear transform (Hartley and Zisserman, section 12.2) and then Gauss-Newton. No memory
/// is allocated.
Triangulation triangulate(std::span<const TriangulationView> views, const Pinhole& camera,
                          const TriangulationOptions& options = {});

}  // namespace cairn
