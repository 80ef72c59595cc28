#pragma once

#include <ceres/manifold.h>

#include "cairn/geometry/ellipsoid.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {

/// An ellipsoid in ten numbers, (qx, qy, qz, qw, tx, ty, tz, log s₁, log s₂, log s₃), updated by
/// (T · exp(ξ), log s + δ): logarithms keep the semi-axes positive.
///
/// As with SE3Manifold, cost functions write their derivative by the nine numbers of the step
/// (translation, rotation, log semi-axes) into the first nine of the ten columns; PlusJacobian is
/// [I; 0].
class ObjectManifold : public ceres::Manifold {
 public:
  static constexpr int kAmbient = 10, kTangent = 9;
  using Step = Eigen::Matrix<double, kTangent, 1>;

  static void pack(const Ellipsoid& ellipsoid, double* x) {
    SE3Manifold::pack(ellipsoid.T, x);
    log_axes(x) = ellipsoid.semi_axes.array().log();
  }
  static Ellipsoid unpack(const double* x) {
    return {SE3Manifold::unpack(x), log_axes(x).array().exp()};
  }
  static Eigen::Map<Eigen::Vector3d> log_axes(double* x) {
    return Eigen::Map<Eigen::Vector3d>(x + 7);
  }
  static Eigen::Map<const Eigen::Vector3d> log_axes(const double* x) {
    return Eigen::Map<const Eigen::Vector3d>(x + 7);
  }

  int AmbientSize() const override { return kAmbient; }
  int TangentSize() const override { return kTangent; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Vector3d axes = log_axes(x) + Eigen::Map<const Eigen::Vector3d>(delta + 6);
    pose_.Plus(x, delta, x_plus_delta);
    log_axes(x_plus_delta) = axes;
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kAmbient, kTangent, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.topRows<kTangent>().setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    pose_.Minus(y, x, y_minus_x);
    Eigen::Map<Eigen::Vector3d>(y_minus_x + 6) = log_axes(y) - log_axes(x);
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kTangent, kAmbient, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.leftCols<kTangent>().setIdentity();
    return true;
  }

 private:
  SE3Manifold pose_;
};

}  // namespace cairn
