#pragma once

#include <ceres/sized_cost_function.h>

namespace cairn {

/// Depth that a network predicts at a keypoint, in units that all pictures share but for an error:
/// (ln z − ln d − s) / σ, where z is the depth of the point in the camera, d the predicted one in
/// metres, and s the logarithm of the units of the map a metre. Blocks: T_wc (see SE3Manifold),
/// X_w, s. A point behind the camera says nothing. Derivation: docs/factors/predicted_depth.md.
class PredictedDepthFactor : public ceres::SizedCostFunction<1, 7, 3, 1> {
 public:
  /// `depth`: metres, positive; `sigma`: of its logarithm.
  PredictedDepthFactor(double depth, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double log_depth_, inverse_sigma_;
};

}  // namespace cairn
