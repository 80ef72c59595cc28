#include "cairn/geometry/resection.h"

#include <gmock/gmock.h>

#include <limits>

#include "cairn/geometry/p3p.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::kCamera;
using testing::Random;
using testing::rotation_error_deg;
using testing::Scene;
using testing::SceneBuilder;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The second camera of a two-view scene is the one to locate.
ResectionResult locate(const Scene& scene, std::uint64_t seed = 1) {
  return resect({scene.points, scene.pixels2, {}}, kCamera, {}, seed);
}

double pose_error(const SE3& a, const SE3& b) {
  return (a.matrix3() - b.matrix3()).norm() + (a.translation() - b.translation()).norm();
}

TEST(P3P, HasTheExactPoseAmongItsCandidates) {
  Random random(1);
  std::vector<double> errors;
  for (int trial = 0; trial < 2000; ++trial) {
    const SE3 T_cw = random.motion(3, 2);
    std::array<Vector3d, 3> rays, points;
    for (int i = 0; i < 3; ++i) {
      const Vector3d X_c(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(1, 6));
      rays[i] = X_c / X_c.z();
      points[i] = T_cw.inverse() * X_c;
    }
    const PoseCandidates found = p3p(rays, points);
    double best = 10;
    for (int i = 0; i < found.count; ++i) {
      best = std::min(best, pose_error(found.poses[i], T_cw));
      for (int k = 0; k < 3; ++k) {
        const Vector3d X = found.poses[i] * points[k];
        EXPECT_LT(X.normalized().cross(rays[k].normalized()).norm(), 1e-3) << trial;
      }
    }
    errors.push_back(best);
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[1000], 1e-12);
  EXPECT_LT(errors[1980], 1e-7);
  EXPECT_LT(errors[1996], 1e-2);
}

TEST(P3P, GivesNothingForPointsOnALineOrNotFinite) {
  const std::array<Vector3d, 3> rays = {Vector3d(0, 0, 1), Vector3d(0.1, 0, 1),
                                        Vector3d(0.2, 0.1, 1)};
  EXPECT_EQ(p3p(rays, {Vector3d(0, 0, 4), Vector3d(1, 0, 4), Vector3d(2, 0, 4)}).count, 0);
  EXPECT_EQ(p3p(rays, {Vector3d(0, 0, 4), Vector3d(0, 0, 4), Vector3d(2, 0, 4)}).count, 0);
  EXPECT_EQ(p3p(rays, {Vector3d(0, kNaN, 4), Vector3d(1, 1, 4), Vector3d(2, 0, 4)}).count, 0);
  EXPECT_EQ(p3p({rays[0], rays[1], Vector3d(kNaN, 0, 1)},
                {Vector3d(0, 0, 4), Vector3d(1, 1, 4), Vector3d(2, 0, 4)})
                .count,
            0);
}

TEST(Resect, FindsTheExactPose) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const SE3 T_21 = Random(seed).motion(0.2, 0.5);
    const ResectionResult result = locate(SceneBuilder(seed).motion(T_21).count(60).build(), seed);
    ASSERT_TRUE(result.usable) << result.refusal;
    EXPECT_LT(pose_error(result.T_cw, T_21), 1e-8);
    EXPECT_EQ(result.inliers, 60);
  }
}

TEST(Resect, FindsThePoseAmongFiftyPercentOutliers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = SceneBuilder(seed).noise(1).outliers(0.5).count(120).build();
    const ResectionResult result = locate(scene, seed);
    ASSERT_TRUE(result.usable) << result.refusal;
    EXPECT_LT(rotation_error_deg(result.T_cw, scene.T_21), 0.3) << seed;
    EXPECT_LT((result.T_cw.translation() - scene.T_21.translation()).norm(), 0.03) << seed;
    EXPECT_GT(result.inliers, 45);
    EXPECT_LT(result.rms_sigmas, 1.6);
    int wrong = 0;
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      wrong += result.inlier[i] && scene.is_outlier[i];
    }
    EXPECT_LE(wrong, 1) << seed;
  }
}

TEST(Resect, FindsThePoseFromPointsOnAPlane) {
  const Scene scene = SceneBuilder(3).planar().noise(0.5).outliers(0.2).build();
  const ResectionResult result = locate(scene);
  ASSERT_TRUE(result.usable) << result.refusal;
  EXPECT_LT(rotation_error_deg(result.T_cw, scene.T_21), 0.3);
}

TEST(Resect, WeighsEachPointByItsSigma) {
  Scene scene = SceneBuilder(4).count(80).build();
  Random random(5);
  std::vector<double> sigmas(80, 0.2);
  for (int i = 0; i < 80; ++i) {
    if (i % 2 == 0) sigmas[i] = 5;
    scene.pixels2[i] += sigmas[i] * random.gaussian3().head<2>();
  }
  const ResectionResult fair = resect({scene.points, scene.pixels2, sigmas}, kCamera, {}, 1);
  ASSERT_TRUE(fair.usable) << fair.refusal;
  EXPECT_GT(fair.inliers, 65);
  EXPECT_LT(rotation_error_deg(fair.T_cw, scene.T_21), 0.05);
}

TEST(Resect, RefusesPointsThatHaveNothingInCommon) {
  const ResectionResult result = locate(SceneBuilder(2).outliers(1).count(60).build());
  EXPECT_FALSE(result.usable);
  EXPECT_THAT(result.refusal, HasSubstr("of 60 points agree with one pose"));
}

TEST(Resect, RefusesTooFewPointsAndPassesOverThoseThatAreNotNumbers) {
  Scene scene = SceneBuilder(2).count(20).build();
  for (int i = 0; i < 8; ++i) scene.pixels2[i].x() = kNaN;
  const ResectionResult few = locate(scene);
  EXPECT_FALSE(few.usable);
  EXPECT_EQ(few.refusal, "only 12 points are seen; 15 are needed");
  scene = SceneBuilder(2).count(40).build();
  for (int i = 0; i < 8; ++i) scene.points[i].x() = kNaN;
  const ResectionResult result = locate(scene);
  ASSERT_TRUE(result.usable) << result.refusal;
  EXPECT_EQ(result.inliers, 32);
  EXPECT_FALSE(locate(Scene{}).usable);
}

TEST(RefinePose, ComesBackFromADisturbedPose) {
  const Scene scene = SceneBuilder(6).count(60).build();
  const std::vector<char> all(60, 1);
  Vector6d xi;
  xi << 0.1, -0.1, 0.1, 0.05, -0.05, 0.05;
  const SE3 refined =
      refine_pose(scene.T_21 * SE3::exp(xi), {scene.points, scene.pixels2, {}}, kCamera, all, 20);
  EXPECT_LT(pose_error(refined, scene.T_21), 1e-8);
}

}  // namespace
}  // namespace cairn
