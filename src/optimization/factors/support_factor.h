#pragma once

#include <ceres/cost_function.h>

#include "cairn/optimization/factors/factor_form.h"

namespace cairn {

/// Whether a plane and an object hang on two keyframes or on one and the same.
enum class SupportFrames { kOne, kTwo };

/// An object stands on a plane. Blocks: T_wp, π_p, T_wr, the object in r, and with one frame, whose
/// pose drops out, π, the object (see SE3Manifold, PlaneManifold, ObjectManifold). Paper:
/// πᵀ Q̂* π / σ, Q̂* of unit Frobenius norm in the ellipsoid's own frame, which the object meets on
/// either side of the plane. Robust: the gap between surface and plane over σ, negative where the
/// plane cuts in. Derivation: docs/factors/support.md.
class SupportFactor : public ceres::CostFunction {
 public:
  /// `side`: 1 where the object is on the side that the plane's normal points to, −1 on the other;
  /// robust form only. `sigma`: units of the map; paper form: of their square.
  SupportFactor(FactorForm form, SupportFrames frames, double side, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  SupportFrames frames_;
  double side_, inverse_sigma_;
};

}  // namespace cairn
