#pragma once

#include "cairn/optimization/factors/factor_form.h"
#include "cairn/optimization/factors/plane_pair_factor.h"

namespace cairn {

/// Two planes are parallel, whichever their sides. Blocks: see PlanePairFactor. Paper:
/// (|n₁ᵀn₂| − 1) / σ, one residual, flat at its solution. Robust: n₁ × n₂ along the axes of n₁'s
/// tangent plane over σ, two residuals. `sigma`: radians. docs/factors/parallel_planes.md.
class ParallelPlanesFactor final : public PlanePairFactor {
 public:
  ParallelPlanesFactor(FactorForm form, PlaneFrames frames, double sigma)
      : PlanePairFactor(frames, form == FactorForm::kPaper ? 1 : 2),
        form_(form),
        inverse_sigma_(1.0 / sigma) {}

 private:
  Residual relate(const Eigen::Vector3d& n1, const Eigen::Vector3d& n2, ByNormal& by_n1,
                  ByNormal& by_n2) const override;

  FactorForm form_;
  double inverse_sigma_;
};

}  // namespace cairn
