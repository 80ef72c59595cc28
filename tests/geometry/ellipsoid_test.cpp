#include "cairn/geometry/ellipsoid.h"

#include <gtest/gtest.h>

#include "scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

Ellipsoid ball(double radius, const Vector3d& centre = Vector3d::Zero()) {
  return {SE3(Eigen::Quaterniond::Identity(), centre), Vector3d::Constant(radius)};
}

Ellipsoid random_ellipsoid(testing::Random& random, double longest) {
  const auto axis = [&] { return std::exp(random.uniform(0, std::log(longest))); };
  const double a = axis(), b = axis(), c = axis();
  return {random.motion(M_PI, random.uniform(0, 1)), {a, b, c}};
}

TEST(EllipsoidIou, IsOneForTheSameAndZeroForSeparateOnes) {
  testing::Random random(1);
  for (int i = 0; i < 20; ++i) {
    const Ellipsoid a = random_ellipsoid(random, 20);
    EXPECT_NEAR(intersection_over_union(a, a), 1, 1e-9);
    Ellipsoid far = a;
    far.T = SE3(a.T.rotation(), a.T * Vector3d(0, 2.001 * a.semi_axes.y(), 0));
    EXPECT_EQ(intersection_over_union(a, far), 0);
  }
}

TEST(EllipsoidIou, IsTheRatioOfVolumesWhereOneContainsTheOther) {
  testing::Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Ellipsoid a = random_ellipsoid(random, 10);
    Ellipsoid b = a;
    b.semi_axes = a.semi_axes.cwiseProduct(Vector3d(0.9, 0.5, 0.7));
    EXPECT_NEAR(intersection_over_union(a, b), 0.9 * 0.5 * 0.7, 1e-9);
    EXPECT_NEAR(intersection_over_union(b, a), 0.9 * 0.5 * 0.7, 1e-9);
  }
}

TEST(EllipsoidIou, IsThatOfTheLensOfTwoBalls) {
  for (const double d : {0.1, 0.5, 1.0, 1.5, 1.9}) {
    const double lens = M_PI * (4 + d) * (2 - d) * (2 - d) / 12;  // two unit balls, d apart
    const double expected = lens / (2 * 4 * M_PI / 3 - lens);
    EXPECT_NEAR(intersection_over_union(ball(1), ball(1, {0.6 * d, 0, 0.8 * d})), expected, 1e-3);
    Ellipsoid a = ball(1), b = ball(1, {0, 0, d});  // a stretched space changes nothing
    a.semi_axes = b.semi_axes = Vector3d(0.05, 3, 1);
    EXPECT_NEAR(intersection_over_union(a, b), expected, 1e-3);
  }
}

TEST(EllipsoidIou, AgreesWithCountingRandomPoints) {
  testing::Random random(3);
  for (int trial = 0; trial < 30; ++trial) {
    const Ellipsoid a = random_ellipsoid(random, 20), b = random_ellipsoid(random, 20);
    int inside = 0, drawn = 0;
    while (drawn < 100'000) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      if (x * x + y * y + z * z > 1) continue;
      ++drawn;
      inside += b.contains(a.T * a.semi_axes.cwiseProduct(Vector3d(x, y, z)));
    }
    const double shared = a.volume() * inside / drawn;
    const double counted = shared / (a.volume() + b.volume() - shared);
    EXPECT_NEAR(intersection_over_union(a, b), counted, 0.005);
    EXPECT_EQ(intersection_over_union(a, b), intersection_over_union(b, a));
  }
}

TEST(Ellipsoid, ContainsWhatIsWithinItsAxes) {
  const Ellipsoid e{SE3(so3_exp({0, 0, M_PI / 2}), {1, 0, 0}),
                    {3, 1, 2}};  // its x is the world's y
  EXPECT_TRUE(e.contains({1, 2.9, 0}));
  EXPECT_FALSE(e.contains({1, 3.1, 0}));
  EXPECT_FALSE(e.contains({2.1, 0, 0}));
  EXPECT_TRUE(e.contains({1, 0, -1.9}));
  EXPECT_NEAR(e.volume(), 8 * M_PI, 1e-12);
}

TEST(Ellipsoid, ReachesAsFarAsTheFarthestPointOfItsSurface) {
  testing::Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Ellipsoid e = random_ellipsoid(random, 20);
    const Vector3d n = random.direction();
    double farthest = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vector3d on_surface = e.T * e.semi_axes.cwiseProduct(random.direction());
      farthest = std::max(farthest, n.dot(on_surface - e.centre()));
    }
    EXPECT_LE(farthest, e.reach(n) * (1 + 1e-12));
    EXPECT_GT(farthest, 0.99 * e.reach(n));
  }
}

}  // namespace
}  // namespace cairn
