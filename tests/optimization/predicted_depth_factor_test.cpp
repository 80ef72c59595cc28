#include "cairn/optimization/factors/predicted_depth_factor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cairn/optimization/factors/two_rows.h"
#include "factor_check.h"
#include "factor_graph.h"
#include "geometry/planes.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Block;
using testing::expect_true_derivatives;
using testing::FactorGraph;
using testing::Random;
using testing::residual;

Vector3d in_front(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 6)};
}

TEST(PredictedDepthFactor, IsTheRatioOfDepthsInSigmas) {
  Random random(1);
  for (int trial = 0; trial < 30; ++trial) {
    const SE3 T_wc = random.motion(3, 4);
    const Vector3d X_c = in_front(random);
    const double metres = random.uniform(0.3, 8), units = random.uniform(0.1, 10);
    const Eigen::VectorXd e =
        residual(PredictedDepthFactor(metres, 0.2),
                 {Block::of(T_wc), Block::of(Vector3d(T_wc * X_c)), Block::of(std::log(units))});
    EXPECT_NEAR(e[0], std::log(X_c.z() / (units * metres)) / 0.2, 1e-9);
  }
}

TEST(PredictedDepthFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T_wc = random.motion(3.1, random.uniform(0, 5));
    const Vector3d X_w = T_wc * in_front(random);
    expect_true_derivatives(PredictedDepthFactor(random.uniform(0.3, 8), random.uniform(0.1, 1)),
                            {Block::of(T_wc), Block::of(X_w), Block::of(random.uniform(-2, 2))});
  }
}

TEST(PredictedDepthFactor, InTwoRowsItSaysTheSameAndNothingInTheSecond) {
  Random random(4);
  for (int trial = 0; trial < 30; ++trial) {
    const SE3 T_wc = random.motion(3, 4);
    const std::vector<Block> blocks = {Block::of(T_wc),
                                       Block::of(Vector3d(T_wc * in_front(random))),
                                       Block::of(random.uniform(-2, 2))};
    const double metres = random.uniform(0.3, 8);
    const TwoRows<PredictedDepthFactor> factor(metres, 0.2);
    const Eigen::VectorXd e = residual(factor, blocks);
    ASSERT_EQ(e.size(), 2);
    EXPECT_EQ(e[0], residual(PredictedDepthFactor(metres, 0.2), blocks)[0]);
    EXPECT_EQ(e[1], 0);
    expect_true_derivatives(factor, blocks);
  }
}

TEST(PredictedDepthFactor, SaysNothingOfAPointBehindTheCamera) {
  const Eigen::VectorXd e =
      residual(PredictedDepthFactor(1, 0.2),
               {Block::of(SE3()), Block::of(Vector3d(0, 0, -1)), Block::of(0.)});
  EXPECT_EQ(e[0], 0);
}

// Two halves of a map whose units differ: the predicted depths know one unit.
TEST(PredictedDepthFactor, PullsPointsToTheDepthThatAllPicturesShare) {
  Random random(3);
  FactorGraph graph;
  double* camera = graph.add(SE3(), true);
  double* units = graph.add(std::log(2.));
  std::vector<double*> points;
  std::vector<double> metres;
  for (int i = 0; i < 20; ++i) {
    const Vector3d X = in_front(random);
    metres.push_back(X.z() / 3);  // three units a metre
    const bool known = i < 10;
    points.push_back(graph.add(known ? X : Vector3d(1.8 * X), known));
    graph.connect(new PredictedDepthFactor(metres.back(), 0.1), nullptr, camera, points.back(),
                  units);
  }
  graph.solve();
  EXPECT_NEAR(std::exp(*units), 3, 1e-6);
  for (int i = 10; i < 20; ++i) EXPECT_NEAR(points[i][2], 3 * metres[i], 1e-5);
}

}  // namespace
}  // namespace cairn
