#include "cairn/optimization/factors/predicted_depth_factor.h"

#include <cmath>

#include "cairn/optimization/se3_manifold.h"

namespace cairn {

PredictedDepthFactor::PredictedDepthFactor(double depth, double sigma)
    : log_depth_(std::log(depth)), inverse_sigma_(1 / sigma) {}

bool PredictedDepthFactor::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  const SE3 T_wc = SE3Manifold::unpack(parameters[0]);
  const Eigen::Map<const Eigen::Vector3d> X_w(parameters[1]);
  const Eigen::Vector3d X = T_wc.inverse() * X_w;
  constexpr double kMinDepth = 1e-6;
  const bool in_front = X.z() > kMinDepth;
  residuals[0] = in_front ? inverse_sigma_ * (std::log(X.z()) - log_depth_ - parameters[2][0]) : 0;
  if (jacobians == nullptr) return true;
  const double by_z = in_front ? inverse_sigma_ / X.z() : 0;
  if (jacobians[0] != nullptr) {  // T_wc · exp(ξ) moves the point in the camera by -ρ + [X]× ω
    Eigen::Map<Eigen::Matrix<double, 1, 7>> J(jacobians[0]);
    J << 0, 0, -by_z, -by_z * X.y(), by_z * X.x(), 0, 0;
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 1, 3>> J(jacobians[1]);
    J = by_z * T_wc.matrix3().col(2).transpose();
  }
  if (jacobians[2] != nullptr) jacobians[2][0] = in_front ? -inverse_sigma_ : 0;
  return true;
}

}  // namespace cairn
