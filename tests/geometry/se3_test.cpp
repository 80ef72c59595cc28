#include "cairn/geometry/se3.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using testing::Random;

Vector6d random_tangent(Random& random, double angle) {
  Vector6d xi;
  xi << random.gaussian3(), random.direction() * angle;
  return xi;
}

// The matrix exponential by scaling and squaring of its series: slow, and obviously right.
Matrix4d series_exp(const Vector6d& xi) {
  Matrix4d A = Matrix4d::Zero();
  A.topLeftCorner<3, 3>() = skew(xi.tail<3>());
  A.topRightCorner<3, 1>() = xi.head<3>();
  A /= 1024;
  Matrix4d term = Matrix4d::Identity(), sum = term;
  for (int i = 1; i < 12; ++i) sum += term = term * A / i;
  for (int i = 0; i < 10; ++i) sum *= sum.eval();
  return sum;
}

TEST(So3, SkewIsTheCrossProduct) {
  const Vector3d a(1, 2, 3), b(-2, 0.5, 4);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(So3, ComesBackFromItsLogarithmAtEveryAngle) {
  Random random(1);
  for (const double angle : {0.0, 1e-12, 1e-7, 0.9e-5, 1.1e-5, 1e-4, 0.1, 1.0, 3.0, M_PI - 1e-6}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vector3d omega = random.direction() * angle;
      EXPECT_LT((so3_log(so3_exp(omega)) - omega).norm(), 1e-12) << angle;
    }
  }
}

TEST(So3, TakesBothQuaternionsOfARotation) {
  const Vector3d omega(0.3, -0.2, 0.5);
  Eigen::Quaterniond q = so3_exp(omega);
  q.coeffs() *= -1;
  EXPECT_LT((so3_log(q) - omega).norm(), 1e-14);
}

TEST(SE3, ExponentialIsTheMatrixExponential) {
  Random random(2);
  for (const double angle : {0.0, 1e-9, 0.9e-5, 1.1e-5, 1e-4, 1e-2, 1.0, 3.0, 6.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vector6d xi = random_tangent(random, angle);
      EXPECT_LT((SE3::exp(xi).matrix() - series_exp(xi)).norm(), 1e-12) << angle;
    }
  }
}

TEST(SE3, ComesBackFromItsLogarithmAtEveryAngle) {
  Random random(3);
  for (const double angle : {0.0, 1e-12, 1e-7, 0.9e-5, 1.1e-5, 1e-4, 0.1, 1.0, 3.0, M_PI - 1e-6}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Vector6d xi = random_tangent(random, angle);
      EXPECT_LT((SE3::exp(xi).log() - xi).norm(), 1e-10) << angle;
    }
  }
}

TEST(SE3, ComposesAndInvertsLikeItsMatrix) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 A = random.motion(3, 5), B = random.motion(3, 5);
    const Vector3d x = random.gaussian3();
    EXPECT_LT(((A * B).matrix() - A.matrix() * B.matrix()).norm(), 1e-13);
    EXPECT_LT((A.inverse().matrix() - A.matrix().inverse()).norm(), 1e-13);
    EXPECT_LT((A.inverse() * (A * x) - x).norm(), 1e-13);
  }
}

TEST(SE3, RightUpdateMovesAPointByItsJacobian) {
  Random random(5);
  const SE3 T = random.motion(2, 3);
  const Vector3d x = random.gaussian3();
  // d(T exp(xi) x) / d xi = R [I, -[x]x]
  Eigen::Matrix<double, 3, 6> J;
  J << T.matrix3(), -T.matrix3() * skew(x);
  const double h = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Vector6d xi = Vector6d::Unit(k) * h;
    const Vector3d numeric = (T * SE3::exp(xi) * x - T * SE3::exp(-xi) * x) / (2 * h);
    EXPECT_LT((numeric - J.col(k)).norm(), 1e-8) << k;
  }
}

TEST(SE3, AdjointTakesAStepToTheOtherSide) {
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    const SE3 T = random.motion(3, 5);
    const Vector6d xi = random_tangent(random, 0.5);
    const SE3 left = SE3::exp(adjoint(T) * xi) * T, right = T * SE3::exp(xi);
    EXPECT_LT((left.matrix() - right.matrix()).norm(), 1e-12);
  }
}

TEST(SE3, KnowsWhenItIsNotFinite) {
  EXPECT_TRUE(SE3().is_finite());
  EXPECT_FALSE(SE3(Eigen::Quaterniond::Identity(), Vector3d(0, NAN, 0)).is_finite());
  EXPECT_FALSE(SE3::exp(Vector6d::Constant(INFINITY)).is_finite());
}

}  // namespace
}  // namespace cairn
