#include "cairn/optimization/factors/unit_factor.h"

#include <algorithm>

namespace cairn {

bool UnitFactor::Evaluate(double const* const* parameters, double* residuals,
                          double** jacobians) const {
  const Eigen::Map<const Eigen::Quaterniond> q(parameters[0]);
  const Eigen::Vector3d arm = Eigen::Map<const Eigen::Vector3d>(parameters[0] + 4) - origin_;
  const double distance = std::max(arm.norm(), 1e-12);
  residuals[0] = (distance / length_ - 1) / kSigma;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<Eigen::Matrix<double, 1, 7>> J(jacobians[0]);
  J.setZero();  // T · exp(ξ) moves t by R ρ
  J.head<3>() = (arm / distance).transpose() * q.toRotationMatrix() / (length_ * kSigma);
  return true;
}

}  // namespace cairn
