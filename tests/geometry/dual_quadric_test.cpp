#include "cairn/geometry/dual_quadric.h"

#include <gtest/gtest.h>

#include <limits>

#include "cairn/geometry/cuboid_overlap.h"
#include "cairn/geometry/wasserstein.h"
#include "scene.h"

namespace cairn {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using testing::Random;

Ellipsoid random_ellipsoid(Random& random) {
  Ellipsoid e;
  e.T = random.motion(M_PI, random.uniform(0, 5));
  for (double& axis : e.semi_axes) axis = random.uniform(0.1, 1);
  return e;
}

Cuboid box(const Vector3d& centre, const Vector3d& half) {
  return {SE3(Eigen::Quaterniond::Identity(), centre), half};
}

TEST(DualQuadric, GivesItsEllipsoidBackAtAnyScaleAndSign) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    const Matrix4d Q = dual_quadric(e);
    for (const double scale : {1.0, -3.0, 1e-6, -1e6}) {
      const auto back = ellipsoid_of(scale * Q);
      ASSERT_TRUE(back);
      EXPECT_LT((dual_quadric(*back) - Q).norm(), 1e-9 * Q.norm());
      EXPECT_LT((back->centre() - e.centre()).norm(), 1e-9);
      EXPECT_NEAR(back->volume(), e.volume(), 1e-9);
      EXPECT_NEAR(back->T.matrix3().determinant(), 1, 1e-9);
      EXPECT_NEAR(intersection_over_union(*back, e), 1, 1e-6);
    }
  }
}

TEST(DualQuadric, IsRefusedWhereItIsNoBoundedEllipsoid) {
  Random random(2);
  const Ellipsoid e = random_ellipsoid(random);
  const Matrix4d T = e.T.matrix();
  const auto quadric = [&](double a, double b, double c, double d) {
    return Matrix4d(T * Vector4d(a, b, c, d).asDiagonal() * T.transpose());
  };
  EXPECT_TRUE(ellipsoid_of(quadric(1, 4, 9, -1)));
  EXPECT_TRUE(ellipsoid_of(quadric(-1, -4, -9, 1)));
  EXPECT_FALSE(ellipsoid_of(quadric(1, 4, -9, -1)));  // a hyperboloid
  EXPECT_FALSE(ellipsoid_of(quadric(1, 4, 9, 1)));    // without real points
  EXPECT_FALSE(ellipsoid_of(quadric(1, 4, 0, -1)));   // a disc
  EXPECT_FALSE(ellipsoid_of(Matrix4d::Zero()));
  Matrix4d Q = Matrix4d::Identity();  // its centre is at infinity
  Q(3, 3) = 0;
  EXPECT_FALSE(ellipsoid_of(Q));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Q = dual_quadric(e);
    Q(1, 2) = bad;
    EXPECT_FALSE(ellipsoid_of(Q));
  }
}

TEST(Tangency, IsZeroForPlanesThatTouchAndHasASignBesides) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    const Matrix4d Q = dual_quadric(e);
    const Vector3d n = random.direction();
    const double reach = (n.transpose() * e.T.matrix3() * e.semi_axes.asDiagonal()).norm();
    const auto plane = [&](double distance) {  // of the centre from it
      return Vector4d(n.x(), n.y(), n.z(), distance - n.dot(e.centre()));
    };
    EXPECT_NEAR(tangency(Q, plane(reach)), 0, 1e-12);
    EXPECT_NEAR(tangency(Q, plane(-reach)), 0, 1e-12);
    EXPECT_GT(tangency(Q, plane(0.5 * reach)), 0);
    EXPECT_LT(tangency(Q, plane(1.5 * reach)), 0);
    EXPECT_NEAR(tangency(7 * Q, plane(0.5 * reach)), tangency(Q, plane(0.5 * reach)), 1e-12);
  }
}

TEST(CuboidIou, IsThatOfUprightBoxes) {
  const Cuboid a = box({0, 0, 0}, {1, 2, 3});
  EXPECT_NEAR(intersection_over_union(a, a), 1, 1e-6);
  EXPECT_NEAR(intersection_over_union(a, box({0, 0, 0}, {0.5, 1, 1.5})), 0.125, 1e-6);
  // Half of each one is shared.
  EXPECT_NEAR(intersection_over_union(a, box({1, 0, 0}, {1, 2, 3})), 1.0 / 3, 1e-6);
  const double shared = 1.5 * 3 * 4;  // of volumes of 48
  EXPECT_NEAR(intersection_over_union(a, box({0.5, 1, 2}, {1, 2, 3})), shared / (96 - shared),
              1e-6);
  EXPECT_NEAR(intersection_over_union(a, box({2, 0, 0}, {1, 2, 3})), 0, 1e-6);  // they touch
  EXPECT_EQ(intersection_over_union(a, box({0, 0, 6.1}, {1, 2, 3})), 0);
}

TEST(CuboidIou, IsThatOfACubeTurnedInAnother) {
  const Cuboid a = box({0, 0, 0}, {1, 1, 1});
  const Cuboid b{SE3(so3_exp({0, 0, M_PI / 4}), Vector3d::Zero()), {1, 1, 1}};
  const double octagon = 8 * (std::sqrt(2.0) - 1);  // what two squares of area 4 share
  EXPECT_NEAR(intersection_over_union(a, b), octagon / (8 - octagon), 1e-6);
  // However a small one is turned, it stays inside.
  const Cuboid inner{SE3(so3_exp(Vector3d(1, 1, 0).normalized()), Vector3d::Zero()),
                     Vector3d::Constant(0.5)};
  EXPECT_NEAR(intersection_over_union(a, inner), 0.125, 1e-6);
}

TEST(CuboidIou, IsSymmetricAndTheSameWhereverTheTwoAre) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    Cuboid a{random.motion(M_PI, random.uniform(0, 0.5)), Vector3d::Zero()}, b = a;
    for (double& half : a.half) half = random.uniform(0.2, 1);
    for (double& half : b.half) half = random.uniform(0.2, 1);
    b.T = random.motion(M_PI, random.uniform(0, 0.5));
    const double iou = intersection_over_union(a, b);
    EXPECT_GE(iou, 0);
    EXPECT_LE(iou, 1);
    EXPECT_NEAR(iou, intersection_over_union(b, a), 1e-6);
    const SE3 T = random.motion(M_PI, 20);
    EXPECT_NEAR(iou, intersection_over_union(Cuboid{T * a.T, a.half}, Cuboid{T * b.T, b.half}),
                1e-6);
  }
}

TEST(CuboidIou, AgreesWithCountingRandomPoints) {
  Random random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const Cuboid a = cuboid_of(random_ellipsoid(random));
    const Cuboid b{a.T * random.motion(1, 0.2), a.half.reverse()};
    const SE3 T_ba = b.T.inverse() * a.T;
    int inside = 0;
    constexpr int kPoints = 40'000;
    for (int i = 0; i < kPoints; ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      const Vector3d at = T_ba * a.half.cwiseProduct(Vector3d(x, y, z));
      inside += (at.cwiseAbs().array() <= b.half.array()).all();
    }
    const double shared = a.volume() * inside / kPoints;
    EXPECT_NEAR(intersection_over_union(a, b), shared / (a.volume() + b.volume() - shared), 0.02);
  }
}

TEST(WassersteinDistance, IsZeroForTheSameHoweverItsAxesAreNamed) {
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    const auto renamed = ellipsoid_of(dual_quadric(e));
    ASSERT_TRUE(renamed);
    EXPECT_NEAR(wasserstein_distance(e, e), 0, 1e-6);
    EXPECT_NEAR(wasserstein_distance(e, *renamed), 0, 1e-6);
  }
}

TEST(WassersteinDistance, IsThatOfCentresAndOfAxes) {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Ellipsoid a = random_ellipsoid(random);
    Ellipsoid b = a;
    const Vector3d step = random.gaussian3();
    b.T = SE3(a.T.rotation(), a.centre() + step);
    EXPECT_NEAR(wasserstein_distance(a, b), step.norm(), 1e-6);
    const Vector3d growth(0.1, 0.2, 0.3);  // with common axes it is that of the semi-axes
    b.semi_axes += growth;
    EXPECT_NEAR(wasserstein_distance(a, b), std::hypot(step.norm(), growth.norm()), 1e-6);
    EXPECT_NEAR(wasserstein_distance(a, b), wasserstein_distance(b, a), 1e-9);
  }
}

}  // namespace
}  // namespace cairn
