#include "cairn/optimization/factors/odometry_factor.h"

#include <gtest/gtest.h>

#include <ceres/loss_function.h>

#include "cairn/optimization/factors/point_factor.h"
#include "factor_check.h"
#include "factor_graph.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::Block;
using testing::expect_true_derivatives;
using testing::Random;
using testing::residual;

TEST(OdometryFactor, IsZeroWhereTheTwoLieAsTheyDid) {
  Random random(1);
  const SE3 T_wa = random.motion(1, 2), T_ab = random.motion(0.5, 0.3);
  const OdometryFactor factor(T_ab, 0.1, 0.05);
  EXPECT_LT(residual(factor, {Block::of(T_wa), Block::of(T_wa * T_ab)}).norm(), 1e-9);
}

TEST(OdometryFactor, CountsLengthsAndAnglesInSigmas) {
  const SE3 T_ab(Eigen::Quaterniond::Identity(), {0.3, 0, 0});
  const OdometryFactor factor(T_ab, 0.1, 0.05);
  const SE3 T_wb(Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY())),
                 {0.5, 0, 0});
  const Eigen::VectorXd e = residual(factor, {Block::of(SE3()), Block::of(T_wb)});
  EXPECT_NEAR(e[0], 2, 1e-9);
  EXPECT_NEAR(e[4], 1, 1e-3);
}

TEST(OdometryFactor, HasTrueDerivatives) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const SE3 T_wa = random.motion(3, 2), T_ab = random.motion(0.5, 0.3);
    const OdometryFactor factor(T_ab, 0.1, 0.05);
    expect_true_derivatives(factor,
                            {Block::of(T_wa), Block::of(T_wa * T_ab * random.motion(0.6, 0.5))});
  }
}

// A camera that sees points at a place beside the one where odometry has it.
SE3 placed(int points, double off) {
  Random random(3);
  const SE3 T_wa, T_ab(Eigen::Quaterniond::Identity(), {0.3, 0, 0});
  const SE3 elsewhere = T_ab * SE3(Eigen::Quaterniond::Identity(), {off, 0, 0});
  testing::FactorGraph graph;
  double* b = graph.add(T_ab);
  graph.connect(new OdometryFactor(T_ab, 0.1, 0.05), nullptr, graph.add(T_wa, true), b);
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector3d X(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(3, 5));
    const Pinhole& pinhole = testing::point_view().pinhole();
    graph.connect(new PointFactor(pinhole, pinhole.project(elsewhere.inverse() * X), 0.5),
                  new ceres::CauchyLoss(1), b, graph.add(X, true));
  }
  graph.solve();
  return elsewhere.inverse() * SE3Manifold::unpack(b);
}

TEST(OdometryFactor, HoldsAStepThatOnePointDeniesAndGivesWayToMany) {
  EXPECT_GT(placed(1, 1).translation().norm(), 0.8);
  EXPECT_LT(placed(40, 0.1).translation().norm(), 0.001);
}

}  // namespace
}  // namespace cairn
