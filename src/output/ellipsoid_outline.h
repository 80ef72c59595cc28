#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// Where an ellipsoid of the world shows in a picture of the camera: its outline in pixels, with
/// the bend of the lens, cut just outside of the picture as project_outline does. Empty where
/// nothing is in sight, or where the ellipsoid reaches behind the camera.
std::vector<cv::Point2f> project_ellipsoid(const Ellipsoid& ellipsoid, const SE3& T_cw,
                                           const Camera& camera);

/// The outline of an ellipsoid as it is seen from infinitely far along right × forward (orthogonal
/// unit vectors): points of the plane that these two span, in order, closed: the first one is the
/// last one, too.
std::vector<Eigen::Vector2d> ellipsoid_shadow(const Ellipsoid& ellipsoid,
                                              const Eigen::Vector3d& right,
                                              const Eigen::Vector3d& forward);

}  // namespace cairn
