#include "cairn/geometry/plane.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "geometry/planes.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using testing::IsNearPlane;
using testing::point_on;
using testing::Random;
using testing::random_plane;

TEST(Plane, IsWhatItsHessianFormSays) {
  const Plane plane(Vector3d(0, 0.6, -0.8), 2.5);
  EXPECT_NEAR(plane.coefficients().norm(), 1, 1e-15);
  EXPECT_LT((plane.normal() - Vector3d(0, 0.6, -0.8)).norm(), 1e-15);
  EXPECT_NEAR(plane.offset(), 2.5, 1e-14);
  EXPECT_NEAR(plane.signed_distance(Vector3d::Zero()), 2.5, 1e-14);
  EXPECT_NEAR(plane.signed_distance(Vector3d(7, 0.6, -0.8)), 3.5, 1e-14);
  EXPECT_THAT(Plane::through(Vector3d(1, 2, 3), Vector3d::UnitY()),
              IsNearPlane(Plane(Vector3d::UnitY(), -2), 1e-9, 1e-12));
}

TEST(Plane, TakesHomogeneousVectorsOfAnyLength) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Plane plane = random_plane(random, 20);
    for (const double length : {-3.0, 1e-200, 1e200}) {
      const auto same = Plane::from_coefficients(length * plane.coefficients());
      ASSERT_TRUE(same);
      EXPECT_THAT(*same, IsNearPlane(plane, 1e-9, 1e-9));
      EXPECT_EQ(same->offset() * plane.offset() > 0, length > 0) << "the sides are kept";
    }
  }
}

TEST(Plane, RefusesWhatIsNoPlane) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Plane::from_coefficients({0, 0, 0, 0}));
  EXPECT_FALSE(Plane::from_coefficients({0, 0, 0, 1})) << "the plane at infinity";
  EXPECT_FALSE(Plane::from_coefficients({1e-7, 0, 0, 1}));
  EXPECT_FALSE(Plane::from_coefficients({nan, 0, 1, 1}));
  EXPECT_FALSE(Plane::from_coefficients({0, 0, 1, inf}));
  EXPECT_TRUE(Plane::from_coefficients({0, 0, 1, 0}));
  EXPECT_TRUE(Plane(Vector4d(0, 0, 0, 1)).hessian().allFinite());
  EXPECT_FALSE(Plane(Vector4d(0, 0, 0, 1)).is_finite());
}

TEST(Plane, MovesWithThePointsOnIt) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Plane in_a = random_plane(random, 5);
    const SE3 T_ba = random.motion(3.1, random.uniform(0, 10));
    const Plane in_b = in_a.transformed(T_ba);
    const Vector3d on = point_on(in_a, random, 5), beside = random.gaussian3();
    EXPECT_NEAR(in_b.signed_distance(T_ba * on), 0, 1e-12);
    EXPECT_NEAR(in_b.signed_distance(T_ba * beside), in_a.signed_distance(beside), 1e-12);
    EXPECT_THAT(in_b.transformed(T_ba.inverse()), IsNearPlane(in_a, 1e-9, 1e-12));
    const Plane::Hessian h = Plane::transform(T_ba) * in_a.hessian();
    EXPECT_LT((h - in_b.hessian()).norm(), 1e-12);
    const Eigen::Matrix4d expected = T_ba.inverse().matrix().transpose();
    EXPECT_LT((Plane::transform(T_ba) - expected).norm(), 1e-12);
  }
}

TEST(Plane, ScalesWithTheMap) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Plane plane = random_plane(random, 5);
    const double s = std::exp(random.uniform(-3, 3));
    EXPECT_NEAR(plane.scaled(s).signed_distance(s * point_on(plane, random, 3)), 0, 1e-10);
    EXPECT_NEAR(plane.scaled(s).offset(), s * plane.offset(), 1e-10);
  }
}

TEST(Plane, FacesTheOriginOnDemand) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Plane plane = random_plane(random, 5);
    EXPECT_GE(plane.facing_origin().offset(), 0);
    EXPECT_THAT(plane.facing_origin(), IsNearPlane(plane, 0, 0));
    EXPECT_EQ(plane.flipped().offset(), -plane.offset());
    const Vector3d x = random.gaussian3();
    EXPECT_EQ(plane.flipped().signed_distance(x), -plane.signed_distance(x));
  }
}

TEST(Plane, ExpGoesAlongTheSphereByTheLengthOfTheStep) {
  Random random(5);
  for (const double length : {0.0, 1e-12, 1e-6, 0.9e-5, 1e-3, 0.5, 1.5, 3.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Plane plane = random_plane(random, 5);
      const Vector3d step = length * random.direction();
      const Vector4d x = plane.coefficients(), y = plane.exp(step).coefficients();
      EXPECT_NEAR(y.norm(), 1, 1e-14);
      const Vector4d along = std::cos(length) * x + (length > 0 ? std::sin(length) / length : 1.0) *
                                                        (plane.tangent() * step);
      EXPECT_LT((y - along).norm(), 1e-14);
    }
  }
  const Plane plane = random_plane(random, 5);
  EXPECT_TRUE((plane.tangent().transpose() * plane.tangent()).isIdentity(1e-14));
  EXPECT_LT((plane.tangent().transpose() * plane.coefficients()).norm(), 1e-15);
}

TEST(Plane, LogUndoesExpForEitherSign) {
  Random random(6);
  for (const double length : {0.0, 1e-12, 1e-6, 0.9e-5, 1e-3, 0.5, 1.0, 1.57}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Plane plane = random_plane(random, 5);
      const Vector3d step = length * random.direction();
      EXPECT_LT((plane.log(plane.exp(step)) - step).norm(), 1e-12) << length;
      EXPECT_LT((plane.log(plane.exp(step).flipped()) - step).norm(), 1e-12) << length;
    }
  }
}

TEST(Plane, LogIsNeverLongerThanAQuarterTurn) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Plane a = random_plane(random, 5), b = random_plane(random, 5);
    const double cosine = std::abs(a.coefficients().dot(b.coefficients()));
    EXPECT_NEAR(a.log(b).norm(), std::acos(std::min(cosine, 1.0)), 1e-7);
    EXPECT_NEAR(a.log(b).norm(), b.log(a).norm(), 1e-12);
    EXPECT_LT((a.exp(a.log(b)).coefficients().cwiseAbs() - b.coefficients().cwiseAbs()).norm(),
              1e-12);
  }
}

TEST(Plane, StepsOfAPlaneThroughTheOriginAreTheAnglesOfItsNormal) {
  const Plane floor(Vector3d::UnitY(), 0);
  const Plane tilted(so3_exp({0.3, 0, 0}) * Vector3d::UnitY(), 0);
  EXPECT_NEAR(floor.log(tilted).norm(), 0.3, 1e-14);
}

TEST(Plane, TheDerivativeOfItsHessianFormAgreesWithCentralDifferences) {
  Random random(8);
  constexpr double h = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const Plane plane = random_plane(random, 10);
    Plane::Matrix43d numeric;
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = h * Vector3d::Unit(k);
      numeric.col(k) = (plane.exp(step).hessian() - plane.exp(-step).hessian()) / (2 * h);
    }
    EXPECT_LT((plane.hessian_by_step() - numeric).norm(), 1e-7 * numeric.norm());
  }
}

TEST(Plane, ARayMeetsItAtADepth) {
  Random random(9);
  int met = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Plane plane = random_plane(random, 5);
    const Vector3d ray(random.uniform(-1, 1), random.uniform(-1, 1), 1);
    const auto z = plane.depth_along(ray), flipped = plane.flipped().depth_along(ray);
    EXPECT_EQ(z, flipped);
    if (!z) {
      EXPECT_GE(plane.offset() * plane.normal().dot(ray), 0) << "it lies behind";
      continue;
    }
    ++met;
    EXPECT_GT(*z, 0);
    EXPECT_NEAR(plane.signed_distance(*z * ray), 0, 1e-9);
  }
  EXPECT_GT(met, 50);
  EXPECT_FALSE(Plane(Vector3d::UnitY(), 1).depth_along({0.5, 0, 1})) << "parallel to the plane";
  EXPECT_FALSE(Plane(Vector3d::UnitZ(), 0).depth_along({0.5, 0, 1})) << "through the camera";
}

TEST(AngleBetweenPlanes, IsThatOfTheirNormalsUpToSign) {
  Random random(10);
  for (const double angle : {0.0, 1e-9, 0.2, 1.5}) {
    const Plane a = random_plane(random, 3);
    const Vector3d axis = tangent_axes(a.normal()).col(1);
    const Plane b(so3_exp(angle * axis) * a.normal(), random.uniform(-3, 3));
    EXPECT_NEAR(angle_between(a, b), angle, 1e-12);
    EXPECT_NEAR(angle_between(b.flipped(), a), angle, 1e-12);
  }
}

TEST(TangentAxes, AreARightHandedFrameThatTurnsWithItsSpin) {
  Random random(11);
  constexpr double h = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d n = random.direction();
    Vector3d spin;
    const auto axes = tangent_axes(n, &spin);
    Eigen::Matrix3d frame;
    frame << axes, n;
    EXPECT_TRUE(frame.isUnitary(1e-12));
    EXPECT_NEAR(frame.determinant(), 1, 1e-12);
    const Vector3d sorted = [&] {
      Vector3d a = n.cwiseAbs();
      std::sort(a.data(), a.data() + 3);
      return a;
    }();
    if (sorted[1] - sorted[0] < 1e-4) continue;  // next to a jump
    const Vector3d dn = axes * Eigen::Vector2d(random.gaussian(), random.gaussian());
    const Vector3d turned = (n + h * dn).normalized(), back = (n - h * dn).normalized();
    const double numeric =
        axes.col(1).dot(tangent_axes(turned).col(0) - tangent_axes(back).col(0)) / (2 * h);
    EXPECT_NEAR(spin.dot(dn), numeric, 1e-6);
  }
}

}  // namespace
}  // namespace cairn
