#include "cairn/geometry/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "geometry/planes.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::IsNearPlane;
using testing::point_on;
using testing::Random;
using testing::random_plane;

std::vector<Vector3d> noisy_points(const Plane& plane, int count, double sigma, Random& random) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(point_on(plane, random, 2) + sigma * random.gaussian() * plane.normal());
  }
  return points;
}

// Moves a share of the points anywhere.
void spoil(std::vector<Vector3d>& points, double share, Random& random) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::floor((i + 1) * share) > std::floor(i * share)) points[i] = 3 * random.gaussian3();
  }
}

// (normal along the axes of the estimate, distance at its centroid): what the covariance is of.
Vector3d error(const PlaneFit& fit, const Plane& truth) {
  const Plane same_side = truth.normal().dot(fit.plane.normal()) < 0 ? truth.flipped() : truth;
  Vector3d e;
  e << tangent_axes(fit.plane.normal()).transpose() * same_side.normal(),
      same_side.signed_distance(fit.centroid);
  return e;
}

TEST(PlaneFit, FindsThePlaneOfExactPoints) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Plane plane = random_plane(random, 5);
    const auto points = noisy_points(plane, 3 + random.below(30), 0, random);
    const PlaneFit fit = fit_plane(points);
    ASSERT_TRUE(fit.usable) << fit.refusal;
    EXPECT_THAT(fit.plane, IsNearPlane(plane, 1e-4, 1e-5));
    EXPECT_GE(fit.plane.offset(), 0) << "the origin is on the positive side";
    EXPECT_LT(fit.rms, 1e-6);
    EXPECT_EQ(fit.inliers, int(points.size()));
  }
}

TEST(PlaneFit, ItsCovarianceIsThatOfItsErrors) {
  Random random(2);
  constexpr int kTrials = 400;
  double squared = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Plane plane = random_plane(random, 8);
    const PlaneFit fit = fit_plane(noisy_points(plane, 60, 0.03, random));
    ASSERT_TRUE(fit.usable);
    EXPECT_NEAR(fit.rms, 0.03, 0.015);
    EXPECT_NEAR(fit.plane.signed_distance(fit.centroid), 0, 1e-12);
    const Vector3d e = error(fit, plane);
    squared += e.dot(fit.covariance.ldlt().solve(e));
  }
  EXPECT_NEAR(squared / kTrials, 3, 0.4) << "χ² of three degrees of freedom";
}

TEST(PlaneFit, WeighsPoints) {
  Random random(3);
  const Plane plane = random_plane(random, 3);
  double with = 0, without = 0, squared = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Vector3d> points;
    std::vector<double> weights;
    for (int i = 0; i < 60; ++i) {
      const double sigma = i % 2 == 0 ? 0.01 : 0.2;
      points.push_back(noisy_points(plane, 1, sigma, random).front());
      weights.push_back(1 / (sigma * sigma));
    }
    const PlaneFit fit = fit_plane(points, weights);
    with += angle_between(fit.plane, plane);
    without += angle_between(fit_plane(points).plane, plane);
    const Vector3d e = error(fit, plane);
    squared += e.dot(fit.covariance.ldlt().solve(e));
  }
  EXPECT_LT(with, 0.2 * without);
  EXPECT_NEAR(squared / kTrials, 3, 0.5);
  const std::vector<Vector3d> points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {5, 5, 5}};
  const std::vector<double> weights = {1, 1, 1, 0};
  EXPECT_THAT(fit_plane(points, weights).plane,
              IsNearPlane(Plane(Vector3d::UnitZ(), -1), 1e-6, 1e-9));
  EXPECT_EQ(fit_plane(points, weights).inliers, 3);
}

TEST(PlaneFit, RefusesWhatHoldsNoPlane) {
  std::vector<Vector3d> points = {{0, 0, 1}, {1, 0, 1}};
  EXPECT_FALSE(fit_plane(points).usable);
  EXPECT_THAT(fit_plane(points).to_string(), ::testing::HasSubstr("only 2 points"));
  points = {{0, 0, 1}, {1, 1, 1}, {3, 3, 1}, {-2, -2, 1}};
  EXPECT_THAT(fit_plane(points).refusal, ::testing::HasSubstr("line"));
  points = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  EXPECT_FALSE(fit_plane(points).usable);
  points = {{0, 0, 1}, {1, 0, 1}, {0, 1, std::numeric_limits<double>::quiet_NaN()}, {1, 1, 1}};
  EXPECT_FALSE(fit_plane(points).usable);
  EXPECT_TRUE(fit_plane_robustly(points, {}, {.min_inliers = 3}, 0).usable);
}

TEST(RobustPlaneFit, FindsThePlaneAmongOutliers) {
  Random random(4);
  for (const double outliers : {0.0, 0.2, 0.4}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Plane plane = random_plane(random, 3);
      auto points = noisy_points(plane, 300, 0.01, random);
      spoil(points, outliers, random);
      const PlaneFit fit = fit_plane_robustly(points, {}, {.max_distance = 0.04}, trial);
      ASSERT_TRUE(fit.usable) << fit.refusal;
      EXPECT_THAT(fit.plane, IsNearPlane(plane, 0.25, 0.01)) << outliers;
      EXPECT_GE(fit.inliers, 300 * (1 - outliers) - 3);
      EXPECT_LE(fit.inliers, 300 * (1 - outliers) + 8);
      EXPECT_EQ(std::count(fit.inlier.begin(), fit.inlier.end(), 1), fit.inliers);
      EXPECT_NEAR(fit.rms, 0.01, 0.002);
      EXPECT_LT(error(fit, plane).tail<1>().norm(), 5 * std::sqrt(fit.covariance(2, 2)));
    }
  }
}

TEST(RobustPlaneFit, IsAsGoodAsLeastSquaresWithoutOutliers) {
  Random random(5);
  double robust = 0, plain = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Plane plane = random_plane(random, 3);
    const auto points = noisy_points(plane, 100, 0.01, random);
    robust += angle_between(fit_plane_robustly(points, {}, {}, trial).plane, plane);
    plain += angle_between(fit_plane(points).plane, plane);
  }
  EXPECT_LT(robust, 1.05 * plain);
}

TEST(RobustPlaneFit, GivesTheSameForTheSameSeed) {
  Random random(6);
  auto points = noisy_points(random_plane(random, 3), 200, 0.02, random);
  spoil(points, 0.4, random);
  const PlaneFit a = fit_plane_robustly(points, {}, {}, 9),
                 b = fit_plane_robustly(points, {}, {}, 9);
  EXPECT_EQ(a.plane.coefficients(), b.plane.coefficients());
  EXPECT_EQ(a.inlier, b.inlier);
}

TEST(RobustPlaneFit, AWeightMakesTheGateOfItsPointNarrowOrWide) {
  Random random(7);
  const Plane plane = random_plane(random, 3);
  auto points = noisy_points(plane, 100, 0.005, random);
  std::vector<double> weights(points.size(), 1.0);
  points[0] += 0.1 * plane.normal();
  EXPECT_FALSE(fit_plane_robustly(points, weights, {}, 1).inlier[0]);
  weights[0] = 0.1;
  EXPECT_TRUE(fit_plane_robustly(points, weights, {}, 1).inlier[0]);
}

TEST(RobustPlaneFit, SaysWhyThereIsNone) {
  Random random(8);
  std::vector<Vector3d> cloud;
  for (int i = 0; i < 50; ++i) cloud.push_back(10 * random.gaussian3());
  const PlaneFit fit = fit_plane_robustly(cloud, {}, {}, 1);
  EXPECT_FALSE(fit.usable);
  EXPECT_THAT(fit.refusal, ::testing::HasSubstr("of 50 points lie on one plane; 10 are needed"));
  EXPECT_FALSE(fit_plane_robustly({}, {}, {}, 1).usable);
  std::vector<Vector3d> line;
  for (int i = 0; i < 50; ++i) line.push_back(Vector3d(1, 2, 3) + i * Vector3d(0.1, 0.2, -0.1));
  EXPECT_FALSE(fit_plane_robustly(line, {}, {}, 1).usable);
}

}  // namespace
}  // namespace cairn
