#include "cairn/optimization/factors/point_factor.h"

namespace cairn {

bool PointFactor::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  using RowMajor27 = Eigen::Matrix<double, 2, 7, Eigen::RowMajor>;
  using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  const Eigen::Map<const Eigen::Quaterniond> q(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> t(parameters[0] + 4);
  const Eigen::Map<const Eigen::Vector3d> X_w(parameters[1]);
  const Eigen::Matrix3d R_cw = q.conjugate().toRotationMatrix();
  Eigen::Vector3d X = R_cw * (X_w - t);
  // A point that a step pushes behind the camera keeps a finite, large residual: the step is then
  // refused by the solver, where a failed evaluation would end it.
  const double min_z = 1e-3 * std::max(1e-3, X.norm());
  if (!(X.z() > min_z)) X.z() = min_z;

  Eigen::Map<Eigen::Vector2d> e(residuals);
  e = (pinhole_.project(X) - pixel_) * inverse_sigma_;
  if (jacobians == nullptr) return true;

  const double zi = 1.0 / X.z();
  const double fx = pinhole_.fx * zi * inverse_sigma_, fy = pinhole_.fy * zi * inverse_sigma_;
  const double x = X.x() * zi, y = X.y() * zi;
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor27> J(jacobians[0]);
    J << -fx, 0, fx * x, fx * x * X.y(), -fx * (X.z() + x * X.x()), fx * X.y(), 0,  //
        0, -fy, fy * y, fy * (X.z() + y * X.y()), -fy * y * X.x(), -fy * X.x(), 0;
  }
  if (jacobians[1] != nullptr) {
    Eigen::Matrix<double, 2, 3> J_c;
    J_c << fx, 0, -fx * x, 0, fy, -fy * y;
    Eigen::Map<RowMajor23>(jacobians[1]).noalias() = J_c * R_cw;
  }
  return true;
}

}  // namespace cairn
