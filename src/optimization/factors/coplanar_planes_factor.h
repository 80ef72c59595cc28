#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "cairn/optimization/factors/plane_pair_factor.h"

namespace cairn {

/// Two landmarks are parts of one plane: where the second passes a place, the first does, too. That
/// they are parallel is the business of another factor. Blocks: as those of PlanePairFactor. Both
/// forms are this one. Derivation: docs/factors/coplanar_planes.md.
class CoplanarPlanesFactor final : public ceres::CostFunction {
 public:
  /// `place`: in the second's frame, on the plane or near it, where the two should meet; `sigma`:
  /// units of the map.
  CoplanarPlanesFactor(PlaneFrames frames, const Eigen::Vector3d& place, double sigma);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 private:
  PlaneFrames frames_;
  Eigen::Vector3d place_;
  double inverse_sigma_;
};

}  // namespace cairn
