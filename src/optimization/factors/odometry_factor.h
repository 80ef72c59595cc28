#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/se3.h"

namespace cairn {

/// How two keyframes that follow each other lie, as tracking and local adjustments had it:
/// ((R_a^T (t_b − t_a) − t_ab) / σ_t, 2 vec(q_ab⁻¹ q_a⁻¹ q_b) / σ_r), in σ. Blocks: T_wa, T_wb (see
/// SE3Manifold). Derivation: docs/factors/odometry.md.
class OdometryFactor : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  OdometryFactor(const SE3& T_ab, double sigma_translation, double sigma_rotation)
      : T_ab_(T_ab), by_translation_(1 / sigma_translation), by_rotation_(1 / sigma_rotation) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  SE3 T_ab_;
  double by_translation_, by_rotation_;
};

}  // namespace cairn
