#pragma once

// A small graph for tests: blocks that live as long as it does, and a solver that takes 50 steps.

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "cairn/optimization/object_manifold.h"
#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn::testing {

class FactorGraph {
 public:
  double* add(const SE3& T, bool held = false) {
    double* x = values_.emplace_back().data();
    SE3Manifold::pack(T, x);
    return add(x, 7, new SE3Manifold, held);
  }
  double* add(const Plane& plane, bool held = false) {
    double* x = values_.emplace_back().data();
    PlaneManifold::pack(plane, x);
    return add(x, 4, new PlaneManifold, held);
  }
  double* add(const Ellipsoid& ellipsoid, bool held = false) {
    double* x = values_.emplace_back().data();
    ObjectManifold::pack(ellipsoid, x);
    return add(x, 10, new ObjectManifold, held);
  }
  double* add(double value, bool held = false) {
    double* x = values_.emplace_back().data();
    *x = value;
    return add(x, 1, nullptr, held);
  }
  double* add(const Eigen::Vector3d& point, bool held = false) {
    double* x = values_.emplace_back().data();
    Eigen::Map<Eigen::Vector3d>(x, 3) = point;
    return add(x, 3, nullptr, held);
  }
  /// The graph owns factor and loss.
  template <typename... Blocks>
  void connect(ceres::CostFunction* factor, ceres::LossFunction* loss, Blocks*... blocks) {
    problem_.AddResidualBlock(factor, loss, blocks...);
  }
  ceres::Solver::Summary solve(int steps = 50) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = steps;
    options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-14;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    EXPECT_TRUE(summary.IsSolutionUsable()) << summary.message;
    return summary;
  }

 private:
  double* add(double* x, int size, ceres::Manifold* manifold, bool held) {
    problem_.AddParameterBlock(x, size, manifold);
    if (held) problem_.SetParameterBlockConstant(x);
    return x;
  }

  std::deque<std::array<double, 10>> values_;  // do not move as it grows
  ceres::Problem problem_;
};

}  // namespace cairn::testing
