#include "cairn/optimization/factors/object_turn_factor.h"

#include <gtest/gtest.h>

#include "cairn/map/object_classes.h"
#include "cairn/optimization/object_prior.h"
#include "factor_check.h"
#include "factor_graph.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Block;
using testing::expect_true_derivatives;
using testing::FactorGraph;
using testing::Random;
using testing::residual;

ObjectPrior turned(const Eigen::Quaterniond& q, const Vector3d& sigma) {
  ObjectPrior prior;
  prior.turn = q;
  prior.sigma_turn = sigma;
  return prior;
}

TEST(ObjectTurnFactor, IsTheAngleAroundEachAxisInSigmaWhereItIsSmall) {
  Random random(1);
  const Eigen::Quaterniond q = random.motion(3, 2).rotation();
  const Vector3d angle(0.01, -0.02, 0.03);
  const ObjectTurnFactor factor(turned(q, {0.1, 0.2, HUGE_VAL}));
  const Ellipsoid object{SE3(q * so3_exp(angle), {1, 2, 3}), {0.1, 0.2, 0.3}};
  const Eigen::VectorXd e = residual(factor, {Block::of(object)});
  EXPECT_LT((e - Vector3d(0.1, -0.1, 0)).norm(), 1e-4);
}

TEST(ObjectTurnFactor, HasTrueDerivatives) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Ellipsoid object{random.motion(3, 2), {0.1, 0.2, 0.3}};
    const ObjectTurnFactor factor(turned(random.motion(3, 2).rotation(), {0.1, 0.3, 1}));
    expect_true_derivatives(factor, {Block::of(object)});
  }
}

TEST(ObjectTurnFactor, PullsTheHeightUprightAndLeavesTheTurnAroundIt) {
  FactorGraph graph;
  const Vector3d tilted(0.3, 0.8, -0.2);
  double* object = graph.add(Ellipsoid{SE3(so3_exp(tilted), {0, 0, 2}), {0.1, 0.2, 0.3}});
  ObjectPrior prior;
  expect_upright(prior, so3_exp(tilted), {Vector3d::UnitY(), 0.05});
  graph.connect(new ObjectTurnFactor(prior), nullptr, object);
  graph.solve();
  const SE3 T = ObjectManifold::unpack(object).T;
  EXPECT_LT((T.rotation() * Vector3d::UnitY() - Vector3d::UnitY()).norm(), 1e-4);
  EXPECT_NEAR(T.matrix3()(0, 2), std::sin(0.8), 0.1);
}

}  // namespace
}  // namespace cairn
