#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/lens_correction.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// The point factor with a lens that is estimated, too. Blocks: T_wc (see SE3Manifold), X_w, the
/// values of a LensCorrection. Derivation: docs/factors/point.md.
class LensPointFactor : public ceres::SizedCostFunction<2, 7, 3, LensCorrection::kSize> {
 public:
  LensPointFactor(const Pinhole& pinhole, const Eigen::Vector2d& pixel, double sigma)
      : pinhole_(pinhole), pixel_(pixel), inverse_sigma_(1.0 / sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Pinhole pinhole_;
  Eigen::Vector2d pixel_;
  double inverse_sigma_;
};

/// Holds the correction near to nothing: calibrations are wrong by a percent, not by ten.
class LensPriorFactor
    : public ceres::SizedCostFunction<LensCorrection::kSize, LensCorrection::kSize> {
 public:
  explicit LensPriorFactor(const std::array<double, LensCorrection::kSize>& sigma)
      : sigma_(sigma) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::array<double, LensCorrection::kSize> sigma_;
};

}  // namespace cairn
