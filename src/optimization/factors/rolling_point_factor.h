#pragma once

#include "cairn/optimization/factors/point_factor.h"

namespace cairn {

/// The point factor with a rolling shutter whose readout is estimated, too. Blocks: T_wc (see
/// SE3Manifold), X_w, readout in seconds. Derivation: docs/factors/point.md.
class RollingPointFactor : public ceres::SizedCostFunction<2, 7, 3, 1> {
 public:
  /// `pixel`: where an instant shutter sees the point if the readout is `readout`; `drift`: by how
  /// much that moves, in pixels, when the readout is one second longer.
  RollingPointFactor(const Pinhole& pinhole, const Eigen::Vector2d& pixel, double sigma,
                     double readout, const Eigen::Vector2d& drift)
      : at_readout_(pinhole, pixel, sigma), readout_(readout), slope_(-drift / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (!at_readout_.Evaluate(parameters, residuals, jacobians)) return false;
    Eigen::Map<Eigen::Vector2d> e(residuals);
    e += slope_ * (*parameters[2] - readout_);
    if (jacobians != nullptr && jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Vector2d> J(jacobians[2]);
      J = slope_;
    }
    return true;
  }

 private:
  PointFactor at_readout_;
  double readout_;
  Eigen::Vector2d slope_;
};

}  // namespace cairn
