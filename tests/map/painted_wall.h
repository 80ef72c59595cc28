#pragma once

// A painted wall, z = 2, and pictures of it by a camera with a bent lens.

#include <cmath>

#include "cairn/map/point_patch.h"

namespace cairn::testing {

class PaintedWall {
 public:
  static constexpr double kZ = 2;

  PaintedWall()
      : camera_(Camera::Model::kRadialTangential, 320, 240, {260, 258, 161, 118},
                {-0.25, 0.06, 0.001, -0.001, 0}),
        lens_(camera_) {}

  const Camera& camera() const { return camera_; }
  const Pinhole& pinhole() const { return camera_.pinhole(); }

  /// Where the ideal pinhole camera sees a point.
  Eigen::Vector2d pixel(const SE3& T_wc, const Eigen::Vector3d& point) const {
    return pinhole().project(T_wc.inverse() * point);
  }

  Picture show(const SE3& T_wc) const {
    cv::Mat grey(camera_.height(), camera_.width(), CV_8UC1);
    for (int r = 0; r < grey.rows; ++r) {
      for (int c = 0; c < grey.cols; ++c) {
        const Eigen::Vector3d ray = T_wc.matrix3() * camera_.unproject(Eigen::Vector2d(c, r));
        const double t = (kZ - T_wc.translation().z()) / ray.z();
        const Eigen::Vector3d X = T_wc.translation() + t * ray;
        grey.at<std::uint8_t>(r, c) = cv::saturate_cast<std::uint8_t>(paint(X.x(), X.y()));
      }
    }
    Picture picture{{}, &lens_};
    picture.pyramid.reset(grey, 4, 1.2);
    for (int level = 1; level < 4; ++level) picture.pyramid.compute(level);
    return picture;
  }

 private:
  static double paint(double x, double y) {
    return 128 + 40 * std::sin(71 * x + 26 * y) + 35 * std::cos(78 * y - 20 * x) +
           20 * std::sin(40 * x - 52 * y + 1);
  }

  Camera camera_;
  Undistorter lens_;
};

}  // namespace cairn::testing
