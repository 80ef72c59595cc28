#pragma once

#include <ceres/cost_function.h>

#include <algorithm>
#include <utility>

namespace cairn {

/// A factor of one residual on a map point, with a second residual that is always zero. Ceres
/// eliminates points in loops of known length only where all that concerns them has as many rows,
/// and that of a keypoint has two.
template <class Factor>
class TwoRows final : public ceres::CostFunction {
 public:
  template <class... Arguments>
  explicit TwoRows(Arguments&&... arguments) : factor_(std::forward<Arguments>(arguments)...) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = factor_.parameter_block_sizes();
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (!factor_.Evaluate(parameters, residuals, jacobians)) return false;
    residuals[1] = 0;
    if (jacobians == nullptr) return true;
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const int size = parameter_block_sizes()[i];
      if (jacobians[i] != nullptr) std::fill_n(jacobians[i] + size, size, 0.0);
    }
    return true;
  }

 private:
  Factor factor_;
};

}  // namespace cairn
