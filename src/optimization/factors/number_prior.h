#pragma once

#include <ceres/sized_cost_function.h>

namespace cairn {

/// (x - expected) / σ of one number. Ceres has such a prior, of matrices that it allocates itself:
/// built with other flags, they must not be freed here.
class NumberPrior : public ceres::SizedCostFunction<1, 1> {
 public:
  NumberPrior(double expected, double sigma) : expected_(expected), inverse_sigma_(1 / sigma) {}
  bool Evaluate(const double* const* x, double* e, double** jacobians) const override {
    e[0] = inverse_sigma_ * (x[0][0] - expected_);
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = inverse_sigma_;
    return true;
  }

 private:
  double expected_, inverse_sigma_;
};

}  // namespace cairn
