#include "cairn/optimization/factors/odometry_factor.h"

#include "cairn/optimization/se3_manifold.h"

namespace cairn {

bool OdometryFactor::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  const SE3 T_wa = SE3Manifold::unpack(parameters[0]), T_wb = SE3Manifold::unpack(parameters[1]);
  const SE3 now = T_wa.inverse() * T_wb;
  Eigen::Quaterniond turn = T_ab_.rotation().conjugate() * now.rotation();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  Eigen::Map<Eigen::Matrix<double, 6, 1>> e(residuals);
  e << by_translation_ * (now.translation() - T_ab_.translation()), 2 * by_rotation_ * turn.vec();
  if (jacobians == nullptr) return true;
  using Jacobian = Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>;
  if (jacobians[0] != nullptr) {
    Jacobian J(jacobians[0]);
    J.setZero();
    J.block<3, 3>(0, 0) = -by_translation_ * Eigen::Matrix3d::Identity();
    J.block<3, 3>(0, 3) = by_translation_ * skew(now.translation());
    J.block<3, 3>(3, 3) = -by_rotation_ *
                          (turn.w() * Eigen::Matrix3d::Identity() - skew(turn.vec())) *
                          T_ab_.matrix3().transpose();
  }
  if (jacobians[1] != nullptr) {
    Jacobian J(jacobians[1]);
    J.setZero();
    J.block<3, 3>(0, 0) = by_translation_ * now.matrix3();
    J.block<3, 3>(3, 3) =
        by_rotation_ * (turn.w() * Eigen::Matrix3d::Identity() + skew(turn.vec()));
  }
  return true;
}

}  // namespace cairn
