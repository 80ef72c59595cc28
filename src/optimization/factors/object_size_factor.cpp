#include "cairn/optimization/factors/object_size_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "cairn/optimization/object_manifold.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Takes log semi-axes to what they have around their mean: their shape.
Matrix3d around_mean() { return Matrix3d::Identity() - Matrix3d::Constant(1.0 / 3); }

}  // namespace

ObjectSizeFactor::ObjectSizeFactor(FactorForm form, const ObjectPrior& prior)
    : form_(form), prior_(prior), sorted_shape_(prior.shape) {
  std::sort(sorted_shape_.data(), sorted_shape_.data() + 3, std::greater<>());
  set_num_residuals(form == FactorForm::kPaper ? 1 : prior.usual > 0 ? 4 : 3);
  *mutable_parameter_block_sizes() = std::vector<std::int32_t>{ObjectManifold::kAmbient};
}

// Two cuboids of unit volume share I and cover 2 − I, where log I = Σ min(u, v) over the axes.
double ObjectSizeFactor::paper_residual(const Vector3d& log_axes,
                                        Eigen::RowVector3d* by_axes) const {
  const Vector3d shape = around_mean() * log_axes;
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return shape[a] > shape[b]; });
  double log_shared = 0;
  Eigen::RowVector3d by_shape = Eigen::RowVector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const int k = order[i];
    log_shared += std::min(shape[k], sorted_shape_[i]);
    by_shape[k] = shape[k] < sorted_shape_[i] ? 1 : 0;
  }
  const double shared = std::exp(log_shared), covered = 2 - shared;
  const double by_log_shared = -2 * shared / (covered * covered * prior_.sigma_shape);
  *by_axes = by_log_shared * by_shape * around_mean();
  return (1 - shared / covered) / prior_.sigma_shape;
}

bool ObjectSizeFactor::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const Vector3d log_axes = ObjectManifold::log_axes(parameters[0]);
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 4, 3> by_axes(num_residuals(), 3);
  if (form_ == FactorForm::kPaper) {
    Eigen::RowVector3d by;
    residuals[0] = paper_residual(log_axes, &by);
    by_axes.row(0) = by;
  } else {
    by_axes.topRows<3>() = around_mean() / prior_.sigma_shape;
    Eigen::Map<Vector3d> shape(residuals);
    shape = by_axes.topRows<3>() * log_axes - prior_.shape / prior_.sigma_shape;
    if (prior_.usual > 0) {
      const double information = std::sqrt(3.0) / prior_.sigma_size;
      residuals[3] = information * (log_axes.mean() - std::log(prior_.usual));
      by_axes.row(3).setConstant(information / 3);
    }
  }
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<RowMajor> J(jacobians[0], num_residuals(), ObjectManifold::kAmbient);
  J.setZero();
  J.middleCols<3>(6) = by_axes;
  return true;
}

}  // namespace cairn
