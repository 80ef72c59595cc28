#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>

#include "cairn/geometry/camera.h"

namespace cairn {

/// How exact depth is: σ² = (relative z)² + (quadratic z²)², metres. The first suits a network, the
/// second a sensor that measures disparity (Khoshelham and Oude Elberink 2012).
struct DepthNoise {
  double relative = 0.03;  ///< share of the depth
  double quadratic_m = 0;  ///< metres at one metre

  double sigma(double z) const { return std::hypot(relative * z, quadratic_m * z * z); }
};

/// A grid of points that covers a picture: grid pixel (u, v) of w x h stands for the picture's
/// pixel
/// ((u + 0.5) W / w - 0.5, (v + 0.5) H / h - 0.5), as in cv::resize.
struct OrganizedCloud {
  cv::Mat_<cv::Vec3f> rays;     ///< camera frame, z = 1; 0 where the lens sees nothing in front
  cv::Mat_<float> depth;        ///< metres along the optical axis; 0: unknown
  cv::Mat_<cv::Vec3f> normals;  ///< camera frame, unit, towards the camera; 0: unknown

  cv::Size size() const { return depth.size(); }
  bool known(int v, int u) const { return depth(v, u) > 0 && normals(v, u) != cv::Vec3f(); }
  Eigen::Vector3d ray(int v, int u) const {
    return Eigen::Map<const Eigen::Vector3f>(rays(v, u).val).cast<double>();
  }
  Eigen::Vector3d normal(int v, int u) const {
    return Eigen::Map<const Eigen::Vector3f>(normals(v, u).val).cast<double>();
  }
  Eigen::Vector3d point(int v, int u) const { return double(depth(v, u)) * ray(v, u); }
};

/// The rays of such a grid over the pictures of a camera, lens included.
cv::Mat_<cv::Vec3f> viewing_rays(const Camera& camera, const cv::Size& grid);

}  // namespace cairn
