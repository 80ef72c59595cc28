#include "cairn/geometry/outline_ellipsoid.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Random;

std::vector<Vector3d> corners(const SE3& T, const Vector3d& half) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 8; ++i) {
    const Vector3d side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    points.push_back(T * half.cwiseProduct(side));
  }
  return points;
}

TEST(OutlineEllipsoid, OfAnEllipsoidIsItself) {
  Random random(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Ellipsoid truth{random.motion(3, 2), Vector3d(0.1, 0.2, 0.35)};
    std::vector<Vector3d> points;
    for (int i = 0; i < 5000; ++i) {
      const Vector3d u = random.gaussian3().normalized();
      points.push_back(truth.T * truth.semi_axes.cwiseProduct(u));
    }
    const auto found = outline_ellipsoid(points);
    ASSERT_TRUE(found);
    EXPECT_GT(intersection_over_union(*found, truth), 0.97);
  }
}

TEST(OutlineEllipsoid, OfACubeIsTheBallThatIsAsWideInTheMean) {
  const auto found = outline_ellipsoid(corners(SE3(), Vector3d::Ones()));
  ASSERT_TRUE(found);
  EXPECT_LT((found->semi_axes - Vector3d::Constant(1.5)).norm(), 0.01);  // mean of |n|₁
  EXPECT_LT(found->centre().norm(), 1e-3);
}

TEST(OutlineEllipsoid, MovesWithTheThing) {
  Random random(2);
  const Vector3d half(0.2, 0.02, 0.1);
  const Ellipsoid still = *outline_ellipsoid(corners(SE3(), half));
  const SE3 T = random.motion(3, 2);
  const Ellipsoid moved = *outline_ellipsoid(corners(T, half));
  EXPECT_GT(intersection_over_union({T * still.T, still.semi_axes}, moved), 0.95);
}

TEST(OutlineEllipsoid, IsNoneForAPlaneAndForTooFewPoints) {
  EXPECT_FALSE(outline_ellipsoid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_FALSE(outline_ellipsoid(corners(SE3(), {1, 1, 0})));
}

}  // namespace
}  // namespace cairn
