#include "cairn/geometry/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Brown's model on the plane z = 1, with its Jacobian.
Vector2d distort_plane(const std::array<double, 5>& d, const Vector2d& p, Matrix2d* J) {
  const auto [k1, k2, p1, p2, k3] = d;
  const double x = p.x(), y = p.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  if (J != nullptr) {
    const double dr = k1 + r2 * (2 * k2 + 3 * k3 * r2);  // d radial / d r2
    (*J)(0, 0) = radial + 2 * x * x * dr + 2 * p1 * y + 6 * p2 * x;
    (*J)(0, 1) = 2 * x * y * dr + 2 * p1 * x + 2 * p2 * y;
    (*J)(1, 0) = (*J)(0, 1);
    (*J)(1, 1) = radial + 2 * y * y * dr + 6 * p1 * y + 2 * p2 * x;
  }
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Vector2d undistort_plane(const std::array<double, 5>& d, const Vector2d& target) {
  Vector2d p = target;
  for (int i = 0; i < 30; ++i) {
    Matrix2d J;
    const Vector2d e = distort_plane(d, p, &J) - target;
    if (e.squaredNorm() < 1e-24) break;
    const Vector2d step = J.inverse() * e;
    if (!step.allFinite()) break;
    p -= step.norm() > 0.5 ? Vector2d(step.normalized() * 0.5) : step;
  }
  return p;
}

double fisheye_radius(const std::array<double, 5>& k, double theta, double* derivative) {
  const double t2 = theta * theta;
  if (derivative != nullptr) {
    *derivative = 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
  }
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double fisheye_angle(const std::array<double, 5>& k, double radius) {
  double theta = std::min(radius, M_PI);
  for (int i = 0; i < 30; ++i) {
    double derivative = 1;
    const double e = fisheye_radius(k, theta, &derivative) - radius;
    if (std::abs(e) < 1e-13 || std::abs(derivative) < 1e-9) break;
    theta = std::clamp(theta - e / derivative, 0.0, M_PI);
  }
  return theta;
}

}  // namespace

Camera::Camera(Model model, int width, int height, const Pinhole& intrinsics,
               const std::array<double, 5>& distortion)
    : model_(model),
      width_(width),
      height_(height),
      intrinsics_(intrinsics),
      distortion_(distortion) {
  auto refuse = [](const std::string& why) {
    throw Error(Error::Kind::kUsage, "calibration: " + why);
  };
  const auto& [fx, fy, cx, cy] = intrinsics;
  auto number = [](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", v);
    return std::string(text);
  };
  if (width < 16 || height < 16) {
    refuse("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
           " is too small; give width and height in pixels, 16 at least");
  }
  for (const double v : {fx, fy, cx, cy}) {
    if (!std::isfinite(v)) refuse("fx, fy, cx, cy must be finite numbers");
  }
  for (const double v : distortion) {
    if (!std::isfinite(v)) refuse("the distortion coefficients must be finite numbers");
  }
  if (fx <= 0 || fy <= 0) {
    refuse("the focal length must be positive, but fx is " + number(fx) + " and fy is " +
           number(fy) + "; give it in pixels");
  }
  if (cx < 0 || cy < 0 || cx >= width || cy >= height) {
    refuse("the principal point (" + number(cx) + ", " + number(cy) +
           ") lies outside of the picture of " + std::to_string(width) + "x" +
           std::to_string(height) + "; give it in pixels of this picture size");
  }
  distorted_ = model == Model::kKannalaBrandt ||
               std::any_of(distortion.begin(), distortion.end(), [](double d) { return d != 0; });
}

Vector2d Camera::project(const Vector3d& X) const {
  if (!distorted_) return intrinsics_.project(X);
  Vector2d p;
  if (model_ == Model::kRadialTangential) {
    p = distort_plane(distortion_, X.head<2>() / X.z(), nullptr);
  } else {
    const double r = X.head<2>().norm();
    if (r < 1e-12) return {intrinsics_.cx, intrinsics_.cy};
    p = X.head<2>() * (fisheye_radius(distortion_, std::atan2(r, X.z()), nullptr) / r);
  }
  return {intrinsics_.fx * p.x() + intrinsics_.cx, intrinsics_.fy * p.y() + intrinsics_.cy};
}

Vector3d Camera::unproject(const Vector2d& pixel) const {
  const Vector3d ray = intrinsics_.unproject(pixel);
  if (!distorted_) return ray.normalized();
  const Vector2d p = ray.head<2>();
  if (model_ == Model::kRadialTangential) {
    return undistort_plane(distortion_, p).homogeneous().normalized();
  }
  const double r = p.norm();
  if (r < 1e-12) return Vector3d::UnitZ();
  const double theta = fisheye_angle(distortion_, r);
  return {p.x() / r * std::sin(theta), p.y() / r * std::sin(theta), std::cos(theta)};
}

Vector2d Camera::undistort(const Vector2d& pixel) const {
  if (!distorted_) return pixel;
  const Vector3d ray = unproject(pixel);
  if (!(ray.z() > 0)) return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return intrinsics_.project(ray);
}

Camera Camera::resized(int width, int height) const {
  // Pixel centres are integers, so the picture's left edge lies at -0.5.
  const double sx = double(width) / width_, sy = double(height) / height_;
  return Camera(model_, width, height,
                {intrinsics_.fx * sx, intrinsics_.fy * sy, (intrinsics_.cx + 0.5) * sx - 0.5,
                 (intrinsics_.cy + 0.5) * sy - 0.5},
                distortion_);
}

std::string Camera::describe() const {
  char text[256];
  std::snprintf(text, sizeof text, "%s %dx%d, fx %.2f fy %.2f cx %.2f cy %.2f%s",
                model_ == Model::kKannalaBrandt ? "fisheye (Kannala-Brandt)" : "pinhole", width_,
                height_, intrinsics_.fx, intrinsics_.fy, intrinsics_.cx, intrinsics_.cy,
                distorted_ ? ", distorted" : "");
  return text;
}

}  // namespace cairn
