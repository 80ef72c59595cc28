#include "cairn/optimization/factors/object_size_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

const ObjectPrior kKnown{.usual = 0.2, .sigma_size = 0.5, .sigma_shape = 0.4};
const ObjectPrior kUnknown{.usual = 0, .sigma_size = 0.5, .sigma_shape = 0.4};

Vector3d random_axes(Random& random) { return (0.5 * random.gaussian3()).array().exp(); }

Ellipsoid random_ellipsoid(Random& random) { return {random.motion(3, 2), random_axes(random)}; }

// Expects things whose semi-axes are as these to each other.
ObjectPrior shaped(const Vector3d& axes) {
  ObjectPrior prior = kKnown;
  prior.shape = axes.array().log();
  prior.shape.array() -= prior.shape.mean();
  return prior;
}

// Of two cuboids of unit volume whose axes are in the same order of length.
double cuboid_iou(Vector3d a, Vector3d b) {
  std::sort(a.data(), a.data() + 3);
  std::sort(b.data(), b.data() + 3);
  a /= std::cbrt(a.prod());
  b /= std::cbrt(b.prod());
  const double shared = a.cwiseMin(b).prod();
  return shared / (a.prod() + b.prod() - shared);
}

TEST(ObjectSizeFactor, RobustFormIsZeroForABallOfTheUsualSizeAndGrowsWithTheSpread) {
  const ObjectSizeFactor factor(FactorForm::kRobust, kKnown);
  ASSERT_EQ(factor.num_residuals(), 4);
  EXPECT_LT(residual(factor, {Block::of(Ellipsoid{SE3(), Vector3d::Constant(0.2)})}).norm(), 1e-12);
  const Vector3d axes(0.4 * std::exp(0.2), 0.4, 0.4 * std::exp(-0.2));
  const Eigen::VectorXd e = residual(factor, {Block::of(Ellipsoid{SE3(), axes})});
  const Eigen::Vector4d expected(0.5, 0, -0.5, std::sqrt(3.0) * std::log(2.0) / 0.5);
  EXPECT_LT((e - expected).norm(), 1e-9);
}

TEST(ObjectSizeFactor, RobustFormIsZeroForTheExpectedShapeAtTheUsualSize) {
  const Vector3d axes(0.4, 0.1, 0.2);  // their geometric mean is 0.2
  const ObjectSizeFactor factor(FactorForm::kRobust, shaped(axes));
  EXPECT_LT(residual(factor, {Block::of(Ellipsoid{SE3(), axes})}).norm(), 1e-9);
  const Vector3d other_order(0.1, 0.4, 0.2);
  EXPECT_GT(residual(factor, {Block::of(Ellipsoid{SE3(), other_order})}).norm(), 1);
}

TEST(ObjectSizeFactor, RobustFormKnowsNoSizeWhereNoneIsUsual) {
  Random random(1);
  const ObjectSizeFactor factor(FactorForm::kRobust, kUnknown);
  ASSERT_EQ(factor.num_residuals(), 3);
  Ellipsoid object = random_ellipsoid(random);
  const Eigen::VectorXd e = residual(factor, {Block::of(object)});
  object.semi_axes *= 7;
  EXPECT_LT((residual(factor, {Block::of(object)}) - e).norm(), 1e-9);
}

TEST(ObjectSizeFactor, PaperFormComparesShapesWhateverTheirSizeAndTheOrderOfTheirAxes) {
  Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const Vector3d shape = random_axes(random);
    const ObjectSizeFactor factor(FactorForm::kPaper, shaped(shape));
    ASSERT_EQ(factor.num_residuals(), 1);
    const Vector3d same = 3 * Vector3d(shape.z(), shape.x(), shape.y());
    EXPECT_NEAR(residual(factor, {Block::of(Ellipsoid{SE3(), same})})[0], 0, 1e-9);
    const Ellipsoid other = random_ellipsoid(random);
    EXPECT_NEAR(residual(factor, {Block::of(other)})[0],
                (1 - cuboid_iou(other.semi_axes, shape)) / 0.4, 1e-9);
  }
}

TEST(ObjectSizeFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<Block> block = {Block::of(random_ellipsoid(random))};
    expect_true_derivatives(ObjectSizeFactor(FactorForm::kRobust, kKnown), block);
    expect_true_derivatives(ObjectSizeFactor(FactorForm::kRobust, kUnknown), block);
    expect_true_derivatives(ObjectSizeFactor(FactorForm::kRobust, shaped(random_axes(random))),
                            block);
    expect_true_derivatives(ObjectSizeFactor(FactorForm::kPaper, shaped(random_axes(random))),
                            block);
  }
}

TEST(ObjectSizeFactor, PullsAnObjectToTheUsualSize) {
  Random random(4);
  FactorGraph graph;
  double* object = graph.add(random_ellipsoid(random));
  graph.connect(new ObjectSizeFactor(FactorForm::kRobust, kKnown), nullptr, object);
  graph.solve();
  EXPECT_LT((ObjectManifold::unpack(object).semi_axes - Vector3d::Constant(0.2)).norm(), 1e-5);
}

TEST(ObjectSizeFactor, PaperFormPullsAnObjectToTheShapeOfItsClass) {
  const Vector3d shape(2, 1, 1), start(0.35, 0.3, 0.28);
  FactorGraph graph;
  double* object = graph.add(Ellipsoid{SE3(), start});
  graph.connect(new ObjectSizeFactor(FactorForm::kPaper, shaped(shape)), nullptr, object);
  graph.solve();
  const double before = 1 - cuboid_iou(start, shape);
  EXPECT_LT(1 - cuboid_iou(ObjectManifold::unpack(object).semi_axes, shape), 0.4 * before);
}

}  // namespace
}  // namespace cairn
