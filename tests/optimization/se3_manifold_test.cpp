#include "cairn/optimization/se3_manifold.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::Random;

Vector6d random_step(Random& random, double size) {
  Vector6d step;
  for (int i = 0; i < 6; ++i) step[i] = random.uniform(-size, size);
  return step;
}

TEST(SE3Manifold, PlusMultipliesFromTheRightAndMinusUndoesIt) {
  Random random(1);
  const SE3Manifold manifold;
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T = random.motion(3.1, random.uniform(0, 10));
    const Vector6d step = random_step(random, 1.5);
    double x[7], y[7];
    Vector6d back;
    SE3Manifold::pack(T, x);
    ASSERT_TRUE(manifold.Plus(x, step.data(), y));
    const SE3 expected = T * SE3::exp(step);
    EXPECT_LT((SE3Manifold::unpack(y).matrix() - expected.matrix()).norm(), 1e-12);
    EXPECT_NEAR(Eigen::Map<Eigen::Vector4d>(y).norm(), 1, 1e-12);
    ASSERT_TRUE(manifold.Minus(y, x, back.data()));
    EXPECT_LT((back - step).norm(), 1e-9);
  }
}

TEST(SE3Manifold, AStepOfNothingChangesNothing) {
  Random random(2);
  const SE3Manifold manifold;
  double x[7], y[7];
  SE3Manifold::pack(random.motion(2, 3), x);
  const Vector6d zero = Vector6d::Zero();
  manifold.Plus(x, zero.data(), y);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(x[i], y[i], 1e-15);
}

TEST(SE3Manifold, PackAndUnpackAreInverse) {
  const SE3 T = Random(3).motion(2, 3);
  double x[7];
  SE3Manifold::pack(T, x);
  EXPECT_EQ(x[3], T.rotation().w()) << "quaternions are stored x, y, z, w";
  EXPECT_EQ(x[4], T.translation().x());
  EXPECT_LT((SE3Manifold::unpack(x).matrix() - T.matrix()).norm(), 1e-14);
}

// Factors write derivatives by the six directions themselves, into the first six columns.
TEST(SE3Manifold, ItsJacobiansPassTheFirstSixColumnsThrough) {
  const SE3Manifold manifold;
  EXPECT_EQ(manifold.AmbientSize(), 7);
  EXPECT_EQ(manifold.TangentSize(), 6);
  double x[7];
  SE3Manifold::pack(Random(4).motion(2, 3), x);
  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> plus;
  Eigen::Matrix<double, 6, 7, Eigen::RowMajor> minus;
  manifold.PlusJacobian(x, plus.data());
  manifold.MinusJacobian(x, minus.data());
  Eigen::Matrix<double, 2, 7> J;
  J.setRandom();
  EXPECT_EQ((J * plus - J.leftCols<6>()).norm(), 0);
  EXPECT_TRUE((minus * plus).isIdentity());
}

}  // namespace
}  // namespace cairn
