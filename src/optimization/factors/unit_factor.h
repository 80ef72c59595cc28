#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/se3.h"

namespace cairn {

/// Holds the unit of a monocular map, which no picture shows: (|t_wc − origin| / length − 1) / σ.
/// Block: T_wc (see SE3Manifold). One such factor takes the scale's freedom and bends nothing else.
class UnitFactor : public ceres::SizedCostFunction<1, 7> {
 public:
  UnitFactor(const Eigen::Vector3d& origin, double length) : origin_(origin), length_(length) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  static constexpr double kSigma = 1e-3;
  Eigen::Vector3d origin_;
  double length_;
};

}  // namespace cairn
