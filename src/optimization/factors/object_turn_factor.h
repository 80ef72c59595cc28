#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/optimization/object_prior.h"

namespace cairn {

/// How an object's axes are turned (see turn_residual). Block: the object (see ObjectManifold).
/// Boxes hardly show how what is nearly round is turned: without this, steps along that direction
/// have no limit. Derivation: docs/factors/object_turn.md.
class ObjectTurnFactor : public ceres::SizedCostFunction<3, 10> {
 public:
  explicit ObjectTurnFactor(const ObjectPrior& prior) : prior_(prior) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  ObjectPrior prior_;
};

}  // namespace cairn
