#include "cairn/optimization/plane_manifold.h"

#include <gtest/gtest.h>

#include "geometry/planes.h"

namespace cairn {
namespace {

using testing::Random;
using testing::random_plane;

TEST(PlaneManifold, PlusIsExpAndMinusUndoesIt) {
  Random random(1);
  const PlaneManifold manifold;
  for (int trial = 0; trial < 100; ++trial) {
    const Plane plane = random_plane(random, 10);
    const Eigen::Vector3d step = random.direction() * random.uniform(0, 1.5);
    double x[4], y[4];
    Eigen::Vector3d back;
    PlaneManifold::pack(plane, x);
    ASSERT_TRUE(manifold.Plus(x, step.data(), y));
    EXPECT_LT((PlaneManifold::unpack(y).coefficients() - plane.exp(step).coefficients()).norm(),
              1e-14);
    EXPECT_NEAR(Eigen::Map<Eigen::Vector4d>(y).norm(), 1, 1e-14);
    ASSERT_TRUE(manifold.Minus(y, x, back.data()));
    EXPECT_LT((back - step).norm(), 1e-12);
  }
}

// Factors write derivatives by the three numbers of a step, into the first three columns.
TEST(PlaneManifold, ItsJacobiansPassTheFirstThreeColumnsThrough) {
  const PlaneManifold manifold;
  EXPECT_EQ(manifold.AmbientSize(), 4);
  EXPECT_EQ(manifold.TangentSize(), 3);
  double x[4];
  PlaneManifold::pack(Plane(), x);
  Eigen::Matrix<double, 4, 3, Eigen::RowMajor> plus;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> minus;
  manifold.PlusJacobian(x, plus.data());
  manifold.MinusJacobian(x, minus.data());
  Eigen::Matrix<double, 2, 4> J;
  J.setRandom();
  EXPECT_EQ((J * plus - J.leftCols<3>()).norm(), 0);
  EXPECT_TRUE((minus * plus).isIdentity());
}

}  // namespace
}  // namespace cairn
