#pragma once

#include <ceres/manifold.h>

#include "cairn/geometry/plane.h"

namespace cairn {

/// A plane in four numbers, π = (n, d) of unit length, updated by Plane::exp (Kaess 2015).
///
/// Ceres' SphereManifold<4> moves along axes that a Householder reflection gives and that flip
/// where the last number changes its sign; those of the group S³ are smooth everywhere. As with
/// SE3Manifold, cost functions write their derivative by the three numbers of the step into the
/// first three of the four columns; PlusJacobian is [I; 0].
class PlaneManifold : public ceres::Manifold {
 public:
  static void pack(const Plane& plane, double* x) {
    Eigen::Map<Eigen::Vector4d>(x, 4) = plane.coefficients();
  }
  static Plane unpack(const double* x) {
    return Plane(Eigen::Vector4d(Eigen::Map<const Eigen::Vector4d>(x)));
  }

  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    pack(unpack(x).exp(Eigen::Map<const Eigen::Vector3d>(delta)), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 4, 3, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.topRows<3>().setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Eigen::Vector3d>(y_minus_x, 3) = unpack(x).log(unpack(y));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.leftCols<3>().setIdentity();
    return true;
  }
};

}  // namespace cairn
