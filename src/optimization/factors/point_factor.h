#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// Reprojection of a point, (π(T_wc⁻¹ X_w) − uv) / σ, in σ. Blocks: T_wc (see SE3Manifold), X_w.
/// Derivation: docs/factors/point.md.
class PointFactor : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  PointFactor(const Pinhole& pinhole, const Eigen::Vector2d& pixel, double sigma)
      : pinhole_(pinhole), pixel_(pixel), inverse_sigma_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Pinhole pinhole_;
  Eigen::Vector2d pixel_;
  double inverse_sigma_;
};

}  // namespace cairn
