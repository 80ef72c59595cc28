#pragma once

// A factor with its blocks, for tests: its residual, and its derivatives against central
// differences along the manifolds of the blocks.

#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "cairn/optimization/object_manifold.h"
#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn::testing {

/// The numbers of a block and how a step changes them.
struct Block {
  std::vector<double> values;
  std::shared_ptr<const ceres::Manifold> manifold;

  static Block of(const SE3& T) {
    Block block{std::vector<double>(7), std::make_shared<SE3Manifold>()};
    SE3Manifold::pack(T, block.values.data());
    return block;
  }
  static Block of(const Plane& plane) {
    Block block{std::vector<double>(4), std::make_shared<PlaneManifold>()};
    PlaneManifold::pack(plane, block.values.data());
    return block;
  }
  static Block of(const Ellipsoid& ellipsoid) {
    Block block{std::vector<double>(10), std::make_shared<ObjectManifold>()};
    ObjectManifold::pack(ellipsoid, block.values.data());
    return block;
  }
  static Block of(double value) {
    return {{value}, std::make_shared<ceres::EuclideanManifold<1>>()};
  }
  static Block of(const Eigen::Vector3d& x) {
    return {{x.x(), x.y(), x.z()}, std::make_shared<ceres::EuclideanManifold<3>>()};
  }

  Block moved(int direction, double length) const {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(manifold->TangentSize());
    step[direction] = length;
    Block result = *this;
    manifold->Plus(values.data(), step.data(), result.values.data());
    return result;
  }
};

inline Eigen::VectorXd residual(const ceres::CostFunction& factor,
                                const std::vector<Block>& blocks) {
  std::vector<const double*> parameters;
  for (const Block& block : blocks) parameters.push_back(block.values.data());
  Eigen::VectorXd e(factor.num_residuals());
  EXPECT_TRUE(factor.Evaluate(parameters.data(), e.data(), nullptr));
  return e;
}

/// Every block's derivative, alone and with the others, to `tolerance` of its size (or of 1).
inline void expect_true_derivatives(const ceres::CostFunction& factor,
                                    const std::vector<Block>& blocks, double tolerance = 1e-6) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  constexpr double h = 1e-6;
  ASSERT_EQ(factor.parameter_block_sizes().size(), blocks.size());
  std::vector<const double*> parameters;
  std::vector<RowMajor> analytic;
  std::vector<double*> pointers;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    ASSERT_EQ(factor.parameter_block_sizes()[b], int(blocks[b].values.size()));
    parameters.push_back(blocks[b].values.data());
    analytic.push_back(RowMajor::Constant(factor.num_residuals(), int(blocks[b].values.size()), 7));
  }
  for (RowMajor& J : analytic) pointers.push_back(J.data());
  Eigen::VectorXd e(factor.num_residuals());
  ASSERT_TRUE(factor.Evaluate(parameters.data(), e.data(), pointers.data()));
  EXPECT_LT((e - residual(factor, blocks)).norm(), 1e-12 * (1 + e.norm()));

  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int size = blocks[b].manifold->TangentSize();
    Eigen::MatrixXd numeric(factor.num_residuals(), size);
    for (int k = 0; k < size; ++k) {
      std::vector<Block> ahead = blocks, behind = blocks;
      ahead[b] = blocks[b].moved(k, h);
      behind[b] = blocks[b].moved(k, -h);
      numeric.col(k) = (residual(factor, ahead) - residual(factor, behind)) / (2 * h);
    }
    EXPECT_LT((analytic[b].leftCols(size) - numeric).norm(), tolerance * (1 + numeric.norm()))
        << "block " << b << ", analytic:\n"
        << analytic[b] << "\nnumeric:\n"
        << numeric;
    const int unused = int(blocks[b].values.size()) - size;
    EXPECT_EQ(analytic[b].rightCols(unused).norm(), 0)
        << "the last column of block " << b << " belongs to no direction";

    RowMajor alone = RowMajor::Constant(analytic[b].rows(), analytic[b].cols(), 7);
    std::vector<double*> only(blocks.size(), nullptr);
    only[b] = alone.data();
    ASSERT_TRUE(factor.Evaluate(parameters.data(), e.data(), only.data()));
    EXPECT_EQ(alone, analytic[b]) << "block " << b << " with the others held";
  }
}

}  // namespace cairn::testing
