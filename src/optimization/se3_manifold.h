#pragma once

#include <ceres/manifold.h>

#include "cairn/geometry/se3.h"

namespace cairn {

/// A pose in seven numbers, (qx, qy, qz, qw, tx, ty, tz), updated by T · exp(ξ).
///
/// Cost functions of this library write their derivative with respect to ξ itself, into the first
/// six of the seven columns; PlusJacobian is therefore [I; 0]. That saves a chain rule through the
/// quaternion in every residual.
class SE3Manifold : public ceres::Manifold {
 public:
  static void pack(const SE3& T, double* x) {
    Eigen::Map<Eigen::Vector4d>(x, 4) = T.rotation().coeffs();
    Eigen::Map<Eigen::Vector3d>(x + 4) = T.translation();
  }
  static SE3 unpack(const double* x) {
    return SE3(Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(x)),
               Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(x + 4)));
  }

  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    pack(unpack(x) * SE3::exp(Eigen::Map<const Vector6d>(delta)), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.topRows<6>().setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d>(y_minus_x, 6) = (unpack(x).inverse() * unpack(y)).log();
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.leftCols<6>().setIdentity();
    return true;
  }
};

}  // namespace cairn
