#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace cairn {

/// The ideal pinhole camera that tracking and mapping work in, pixels. Pixel centres are integers.
struct Pinhole {
  double fx = 0, fy = 0, cx = 0, cy = 0;

  Eigen::Vector2d project(const Eigen::Vector3d& X_c) const {
    return {fx * X_c.x() / X_c.z() + cx, fy * X_c.y() / X_c.z() + cy};
  }
  /// The point of the viewing ray at depth 1.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
  }
};

/// A real camera: a pinhole with radial-tangential distortion (Brown; OpenCV's k1 k2 p1 p2 k3) or a
/// fisheye (Kannala and Brandt 2006, equidistant; OpenCV's k1 k2 k3 k4).
class Camera {
 public:
  enum class Model { kRadialTangential, kKannalaBrandt };

  Camera() = default;
  /// Throws Error(kUsage) with a sentence if a value is not usable: a size below 16 pixels, a focal
  /// length that is not positive, a principal point outside of the picture, anything not finite.
  Camera(Model model, int width, int height, const Pinhole& intrinsics,
         const std::array<double, 5>& distortion = {});

  Model model() const { return model_; }
  int width() const { return width_; }
  int height() const { return height_; }
  const Pinhole& pinhole() const { return intrinsics_; }
  const std::array<double, 5>& distortion() const { return distortion_; }

  /// A point in the camera frame (z > 0 for radial-tangential) to the distorted pixel.
  Eigen::Vector2d project(const Eigen::Vector3d& X_c) const;
  /// A distorted pixel to the unit viewing ray; the inverse of project, by Newton's method.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
  /// A distorted pixel to the pixel where `pinhole()` would see the same ray. NaN where no pinhole
  /// can: a fisheye's ray 90 degrees or more off the axis.
  Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;
  /// The camera of the same lens for pictures of another size (a resized picture).
  Camera resized(int width, int height) const;
  /// One line for people.
  std::string describe() const;

 private:
  Model model_ = Model::kRadialTangential;
  int width_ = 0, height_ = 0;
  Pinhole intrinsics_;
  std::array<double, 5> distortion_{};
  bool distorted_ = false;
};

}  // namespace cairn
