#pragma once

#include "cairn/optimization/factors/plane_pair_factor.h"

namespace cairn {

/// Two planes are perpendicular: n₁ᵀn₂ / σ. Blocks: see PlanePairFactor. `sigma`: radians. Both
/// forms are this one. docs/factors/perpendicular_planes.md.
class PerpendicularPlanesFactor final : public PlanePairFactor {
 public:
  PerpendicularPlanesFactor(PlaneFrames frames, double sigma)
      : PlanePairFactor(frames, 1), inverse_sigma_(1.0 / sigma) {}

 private:
  Residual relate(const Eigen::Vector3d& n1, const Eigen::Vector3d& n2, ByNormal& by_n1,
                  ByNormal& by_n2) const override;

  double inverse_sigma_;
};

}  // namespace cairn
