#pragma once

// Small synthetic scenes with noise, a line each: `Scene scene = SceneBuilder(7).noise(1).build();`

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/sampler.h"
#include "cairn/geometry/se3.h"

namespace cairn::testing {

/// Random numbers for tests, the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : sampler_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * sampler_.uniform(); }
  double gaussian() {  // Box and Muller
    const double u = 1 - sampler_.uniform(), v = sampler_.uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }
  Eigen::Vector3d gaussian3() {
    const double x = gaussian(), y = gaussian(), z = gaussian();
    return {x, y, z};
  }
  Eigen::Vector3d direction() { return gaussian3().normalized(); }
  /// A rotation of up to `max_angle` radians and a translation of length `distance`.
  SE3 motion(double max_angle, double distance) {
    const Eigen::Vector3d omega = direction() * uniform(0, max_angle);
    return SE3(so3_exp(omega), direction() * distance);
  }
  std::uint64_t next() { return sampler_.next(); }
  int below(int n) { return sampler_.below(n); }

 private:
  Sampler sampler_;
};

inline constexpr Pinhole kCamera{500, 505, 319.5, 239.5};  // 640x480

/// Points and what two cameras see of them. The first camera is the world.
struct Scene {
  SE3 T_21;
  std::vector<Eigen::Vector3d> points;  // in the first camera
  std::vector<Eigen::Vector2d> pixels1, pixels2;
  std::vector<char> is_outlier;
};

/// What to make; every setter returns the builder.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::uint64_t seed) : random_(seed) {}

  SceneBuilder& count(int n) { return count_ = n, *this; }
  SceneBuilder& noise(double sigma_px) { return noise_ = sigma_px, *this; }
  SceneBuilder& outliers(double share) { return outliers_ = share, *this; }
  /// All points on the plane n·X = 4 with a normal about 0.35 radians off the optical axis.
  SceneBuilder& planar(bool on = true) { return planar_ = on, *this; }
  SceneBuilder& motion(const SE3& T_21) { return T_21_ = T_21, *this; }
  SceneBuilder& depths(double near, double far) { return near_ = near, far_ = far, *this; }

  Scene build() {
    Scene scene;
    scene.T_21 = T_21_;
    while (static_cast<int>(scene.points.size()) < count_) add_point(scene);
    return scene;
  }

 private:
  Eigen::Vector2d noisy(const Eigen::Vector2d& pixel) {
    const double dx = random_.gaussian(), dy = random_.gaussian();
    return pixel + noise_ * Eigen::Vector2d(dx, dy);
  }
  Eigen::Vector2d anywhere() {
    const double x = random_.uniform(0, 640), y = random_.uniform(0, 480);
    return {x, y};
  }
  static bool visible(const Eigen::Vector2d& p) {
    return p.x() > 0 && p.y() > 0 && p.x() < 639 && p.y() < 479;
  }
  void add_point(Scene& scene) {
    const Eigen::Vector3d ray = kCamera.unproject(anywhere());
    const double depth =
        planar_ ? 4 / Eigen::Vector3d(0.25, -0.25, 0.93).dot(ray) : random_.uniform(near_, far_);
    const Eigen::Vector3d X = ray * depth, X2 = scene.T_21 * X;
    if (X2.z() < 0.1 || !visible(kCamera.project(X2))) return;
    // The share is exact, so that a test does not hang on a draw.
    const std::size_t n = scene.points.size();
    const bool outlier = std::floor((n + 1) * outliers_) > std::floor(n * outliers_);
    scene.points.push_back(X);
    scene.pixels1.push_back(noisy(kCamera.project(X)));
    scene.pixels2.push_back(outlier ? anywhere() : noisy(kCamera.project(X2)));
    scene.is_outlier.push_back(outlier);
  }

  Random random_;
  int count_ = 200;
  double noise_ = 0, outliers_ = 0, near_ = 2, far_ = 8;
  bool planar_ = false;
  SE3 T_21_{so3_exp({0.02, -0.08, 0.01}), Eigen::Vector3d(0.5, 0.05, 0.1)};
};

inline double rotation_error_deg(const SE3& a, const SE3& b) {
  return a.rotation().angularDistance(b.rotation()) * 180 / M_PI;
}

inline double direction_error_deg(const SE3& a, const SE3& b) {
  const Eigen::Vector3d u = a.translation().normalized(), v = b.translation().normalized();
  return std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / M_PI;
}

}  // namespace cairn::testing
