#pragma once

#include <ceres/cost_function.h>

#include "cairn/optimization/factors/factor_form.h"
#include "cairn/optimization/object_prior.h"

namespace cairn {

/// What is known of a thing's shape and size before it is seen. Block: the object (see
/// ObjectManifold). Paper: 1 − IoU of the cuboids around the object and around one of that shape,
/// both of unit volume and laid on each other longest axis to longest, over `sigma_shape`; one
/// residual, which knows no size. Robust: the log semi-axes around their mean, less `shape`, over
/// `sigma_shape`, and where a usual size is known their mean around it, over `sigma_size`; three
/// residuals or four. Derivation: docs/factors/object_size.md.
class ObjectSizeFactor : public ceres::CostFunction {
 public:
  ObjectSizeFactor(FactorForm form, const ObjectPrior& prior);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double paper_residual(const Eigen::Vector3d& log_axes, Eigen::RowVector3d* by_axes) const;

  FactorForm form_;
  ObjectPrior prior_;
  Eigen::Vector3d sorted_shape_;  // the prior's, the largest first
};

}  // namespace cairn
