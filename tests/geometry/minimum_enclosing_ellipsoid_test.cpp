#include "cairn/geometry/minimum_enclosing_ellipsoid.h"

#include <gtest/gtest.h>

#include <vector>

#include "cairn/geometry/sampler.h"
#include "cairn/geometry/se3.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(Sampler& sampler) {
  return Vector3d(sampler.uniform(), sampler.uniform(), sampler.uniform()) * 2 - Vector3d::Ones();
}

double volume(const EnclosingEllipsoid& ellipsoid) { return ellipsoid.semi_axes.prod(); }

TEST(MinimumEnclosingEllipsoid, RecoversTheEllipsoidThatPointsLieOn) {
  Sampler sampler(1);
  for (int trial = 0; trial < 20; ++trial) {
    EnclosingEllipsoid truth;
    truth.centre = 5 * random_vector(sampler);
    truth.rotation = so3_exp(0.4 * random_vector(sampler));
    truth.semi_axes = Vector3d(0.2, 0.5, 1.1) + 0.1 * random_vector(sampler);
    std::vector<Vector3d> points;
    for (int i = 0; i < 4000; ++i) {
      const Vector3d on_sphere = random_vector(sampler).normalized();
      points.emplace_back(truth.centre + truth.rotation * truth.semi_axes.cwiseProduct(on_sphere));
    }
    const auto found = minimum_enclosing_ellipsoid(points);
    ASSERT_TRUE(found);
    EXPECT_LT((found->centre - truth.centre).norm(), 0.02);
    EXPECT_LT((found->semi_axes - truth.semi_axes).norm(), 0.02) << found->semi_axes.transpose();
    EXPECT_LT(found->rotation.angularDistance(truth.rotation), 0.1);
  }
}

TEST(MinimumEnclosingEllipsoid, EnclosesAnyCloudAndIsTight) {
  Sampler sampler(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vector3d> points;
    const int count = 4 + sampler.below(300);
    const Vector3d stretch = Vector3d(1, 0.3, 0.05) + 0.04 * random_vector(sampler);
    for (int i = 0; i < count; ++i) {
      points.emplace_back(stretch.cwiseProduct(random_vector(sampler)) + Vector3d(100, -50, 3));
    }
    const auto found = minimum_enclosing_ellipsoid(points);
    ASSERT_TRUE(found);
    int touching = 0;
    for (const Vector3d& X : points) {
      EXPECT_LE(found->level(X), 1 + 1e-9);
      touching += found->level(X) > 0.98;
    }
    EXPECT_GE(touching, 4);  // fewer could not hold an ellipsoid of least volume
  }
}

// John (1948): the least ellipsoid around a box has sqrt(3) times its half edges.
TEST(MinimumEnclosingEllipsoid, OfABoxIsJohns) {
  const Vector3d half(0.3, 1.2, 0.7);
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(
        half.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  const auto found = minimum_enclosing_ellipsoid(corners, 1e-6);
  ASSERT_TRUE(found);
  EXPECT_LT((found->semi_axes - std::sqrt(3.0) * half).norm(), 1e-3);
  EXPECT_LT(found->centre.norm(), 1e-6);
  EXPECT_NEAR(volume(*found), half.prod() * std::pow(3, 1.5), 1e-3);
}

TEST(MinimumEnclosingEllipsoid, OfAFlatCloudThereIsNone) {
  Sampler sampler(3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 100; ++i) {
    Vector3d X = random_vector(sampler);
    X.z() = 2;
    points.push_back(X);
  }
  EXPECT_FALSE(minimum_enclosing_ellipsoid(points));
  EXPECT_FALSE(minimum_enclosing_ellipsoid(std::span(points).first(3)));
}

}  // namespace
}  // namespace cairn
