#include "cairn/optimization/factors/lens_point_factor.h"

#include <algorithm>

namespace cairn {

bool LensPointFactor::Evaluate(double const* const* parameters, double* residuals,
                               double** jacobians) const {
  constexpr int kLens = LensCorrection::kSize;
  const Eigen::Map<const Eigen::Quaterniond> q(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> t(parameters[0] + 4);
  const Eigen::Map<const Eigen::Vector3d> X_w(parameters[1]);
  LensCorrection lens;
  std::copy_n(parameters[2], kLens, lens.values.begin());
  const Eigen::Matrix3d R_cw = q.conjugate().toRotationMatrix();
  Eigen::Vector3d X = R_cw * (X_w - t);
  X.z() = std::max(X.z(), 1e-3 * std::max(1e-3, X.norm()));  // as in PointFactor

  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix<double, 2, kLens> by_lens;
  Eigen::Map<Eigen::Vector2d> e(residuals);
  e = (lens.project(pinhole_, X, &by_point, &by_lens) - pixel_) * inverse_sigma_;
  if (jacobians == nullptr) return true;
  by_point *= inverse_sigma_;
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> J(jacobians[0]);
    J.leftCols<3>() = -by_point;
    J.middleCols<3>(3) = by_point * skew(X);
    J.col(6).setZero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>(jacobians[1]).noalias() =
        by_point * R_cw;
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, kLens, Eigen::RowMajor>> J(jacobians[2]);
    J = by_lens * inverse_sigma_;
  }
  return true;
}

bool LensPriorFactor::Evaluate(double const* const* parameters, double* residuals,
                               double** jacobians) const {
  for (int i = 0; i < LensCorrection::kSize; ++i) residuals[i] = parameters[0][i] / sigma_[i];
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<Eigen::Matrix<double, LensCorrection::kSize, LensCorrection::kSize, Eigen::RowMajor>>
      J(jacobians[0]);
  J.setZero();
  for (int i = 0; i < LensCorrection::kSize; ++i) J(i, i) = 1.0 / sigma_[i];
  return true;
}

}  // namespace cairn
