#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/plane.h"

namespace cairn {

/// A map point lies on a plane: its signed distance over σ. Blocks: T_wr (see SE3Manifold), π_r
/// (see PlaneManifold), X_w. `sigma`: units of the map, growing with the distance that the point
/// was seen from. Both forms are this one. Derivation: docs/factors/point_on_plane.md.
class PointOnPlaneFactor : public ceres::SizedCostFunction<1, 7, 4, 3> {
 public:
  explicit PointOnPlaneFactor(double sigma) : inverse_sigma_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double inverse_sigma_;
};

}  // namespace cairn
