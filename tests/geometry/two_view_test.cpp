#include "cairn/geometry/two_view.h"

#include <gmock/gmock.h>

#include <limits>

#include "cairn/geometry/epipolar.h"
#include "cairn/geometry/five_point.h"
#include "cairn/geometry/homography.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::direction_error_deg;
using ::testing::HasSubstr;
using testing::kCamera;
using testing::Random;
using testing::rotation_error_deg;
using testing::Scene;
using testing::SceneBuilder;
using Model = TwoViewResult::Model;

TwoViewResult reconstruct(const Scene& scene, std::uint64_t seed = 1) {
  return reconstruct_two_views(scene.pixels1, scene.pixels2, kCamera, {}, seed);
}

// The share of triangulated points that lie within `tolerance` (relative) of the truth.
double share_near_truth(const Scene& scene, const TwoViewResult& result, double tolerance) {
  const double scale = scene.T_21.translation().norm();
  int good = 0, all = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    if (!result.triangulated[i]) continue;
    ++all;
    good +=
        (result.points[i] * scale - scene.points[i]).norm() < tolerance * scene.points[i].norm();
  }
  return all == 0 ? 0 : double(good) / all;
}

TEST(FivePoint, FindsTheTrueEssentialMatrixAmongItsCandidates) {
  Random random(3);
  std::vector<double> errors;
  for (int trial = 0; trial < 500; ++trial) {
    const SE3 T_21 = random.motion(0.5, 1);
    std::array<Eigen::Vector3d, 5> rays1, rays2;
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d X(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(3, 8));
      rays1[i] = X;
      rays2[i] = T_21 * X;
    }
    const Eigen::Matrix3d E = essential_matrix(T_21).normalized();
    const EssentialCandidates found = five_point(rays1, rays2);
    double best = 1;
    for (int i = 0; i < found.count; ++i) {
      best = std::min({best, (found.matrices[i] - E).norm(), (found.matrices[i] + E).norm()});
    }
    errors.push_back(best);
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[250], 1e-10);
  EXPECT_LT(errors[490], 1e-4);
}

TEST(FivePoint, FindsTheTrueEssentialMatrixOfPointsOnAPlane) {
  const Scene scene = SceneBuilder(5).planar().count(5).build();
  std::array<Eigen::Vector3d, 5> rays1, rays2;
  for (int i = 0; i < 5; ++i) {
    rays1[i] = scene.points[i];
    rays2[i] = scene.T_21 * scene.points[i];
  }
  const Eigen::Matrix3d E = essential_matrix(scene.T_21).normalized();
  const EssentialCandidates found = five_point(rays1, rays2);
  double best = 1;
  for (int i = 0; i < found.count; ++i) {
    best = std::min({best, (found.matrices[i] - E).norm(), (found.matrices[i] + E).norm()});
  }
  EXPECT_LT(best, 1e-6);
}

TEST(FivePoint, SurvivesRaysThatAreNotNumbers) {
  std::array<Eigen::Vector3d, 5> rays;
  rays.fill(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(five_point(rays, rays).count, 0);
  rays.fill(Eigen::Vector3d::UnitZ());
  five_point(rays, rays);  // any answer will do
}

TEST(DecomposeEssential, HasTheMotionAmongItsFour) {
  Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_21 = random.motion(1.0, 1);
    double best = 10;
    for (const SE3& T : decompose_essential(essential_matrix(T_21) * random.uniform(-3, 3))) {
      best = std::min(best, rotation_error_deg(T, T_21) + direction_error_deg(T, T_21));
    }
    EXPECT_LT(best, 1e-6);
  }
}

TEST(DecomposeHomography, HasTheMotionAmongItsFour) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_21 = random.motion(0.5, 0.8);
    const Eigen::Vector3d n = (Eigen::Vector3d::UnitZ() + 0.3 * random.gaussian3()).normalized();
    const Eigen::Matrix3d H = T_21.matrix3() + T_21.translation() * n.transpose() / 2.0;
    const HomographyMotions motions = decompose_homography(H * random.uniform(0.5, 3));
    double best = 10;
    for (int i = 0; i < motions.count; ++i) {
      best = std::min(best, rotation_error_deg(motions.motions[i], T_21) +
                                direction_error_deg(motions.motions[i], T_21));
    }
    EXPECT_LT(best, 1e-5);
  }
}

TEST(DecomposeHomography, GivesNoMotionForAPureRotation) {
  EXPECT_EQ(decompose_homography(so3_exp({0.1, 0.2, -0.1}).toRotationMatrix() * 2).count, 0);
}

TEST(TwoView, RecoversAnExactScene) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Scene scene = SceneBuilder(seed).build();
    const TwoViewResult result = reconstruct(scene, seed);
    ASSERT_TRUE(result.usable) << result.refusal;
    EXPECT_EQ(result.model, Model::kEssential);
    EXPECT_LT(rotation_error_deg(result.T_21, scene.T_21), 1e-4);
    EXPECT_LT(direction_error_deg(result.T_21, scene.T_21), 1e-3);
    EXPECT_NEAR(result.T_21.translation().norm(), 1, 1e-12);
    EXPECT_EQ(share_near_truth(scene, result, 1e-3), 1);
  }
}

TEST(TwoView, RecoversANoisySceneWithOutliers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = SceneBuilder(seed).noise(1).outliers(0.3).count(250).build();
    const TwoViewResult result = reconstruct(scene, seed);
    ASSERT_TRUE(result.usable) << seed << ": " << result.refusal;
    EXPECT_LT(rotation_error_deg(result.T_21, scene.T_21), 0.7) << seed;
    EXPECT_LT(direction_error_deg(result.T_21, scene.T_21), 6) << seed;
    EXPECT_GT(result.inliers, 130);
    EXPECT_GT(share_near_truth(scene, result, 0.3), 0.8) << seed;
  }
}

TEST(TwoView, RecoversAForwardMotion) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const SE3 T_21(so3_exp({0.01, 0.02, 0}), Eigen::Vector3d(0.05, 0.02, -0.8));
    const Scene scene = SceneBuilder(seed).noise(0.5).motion(T_21).count(300).build();
    const TwoViewResult result = reconstruct(scene, seed);
    ASSERT_TRUE(result.usable) << seed << ": " << result.refusal;
    EXPECT_LT(rotation_error_deg(result.T_21, T_21), 0.5) << seed;
    EXPECT_LT(direction_error_deg(result.T_21, T_21), 5) << seed;
  }
}

TEST(TwoView, IsNeverWrongOnAPlaneEvenWhereItRefuses) {
  int usable = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SE3 T_21 = Random(seed + 100).motion(0.1, 0.8);
    const Scene scene = SceneBuilder(seed).planar().noise(0.5).motion(T_21).build();
    const TwoViewResult result = reconstruct(scene, seed);
    if (!result.usable) continue;
    ++usable;
    EXPECT_LT(rotation_error_deg(result.T_21, T_21), 1.5) << seed;
    EXPECT_LT(direction_error_deg(result.T_21, T_21), 10) << seed;
  }
  EXPECT_GE(usable, 3);
}

// Where depths differ little, noise makes a motion to the side, with a turn, of one ahead.
TEST(TwoView, HardlyEverTakesASmallMotionAheadForOneToTheSide) {
  const SE3 T_21(so3_exp({0.002, 0.004, 0}), Eigen::Vector3d(0, 0, -0.25));
  int right = 0, wrong = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = SceneBuilder(seed).depths(5, 5.5).noise(1).motion(T_21).count(170).build();
    const TwoViewResult result = reconstruct(scene, seed);
    if (!result.usable) continue;
    ++(direction_error_deg(result.T_21, T_21) > 20 ? wrong : right);
  }
  EXPECT_LE(wrong, 1);
  EXPECT_GE(right, 30);
}

TEST(TwoView, RefusesARotationForItsParallax) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SE3 T_21(so3_exp({0.02, -0.1, 0.03}), Eigen::Vector3d::Zero());
    const Scene scene = SceneBuilder(seed).noise(1).motion(T_21).count(300).build();
    const TwoViewResult result = reconstruct(scene, seed);
    EXPECT_FALSE(result.usable) << seed;
    EXPECT_THAT(result.refusal, HasSubstr("parallax")) << seed;
  }
}

TEST(TwoView, RefusesMatchesThatHaveNothingInCommon) {
  const Scene scene = SceneBuilder(2).outliers(1).count(150).build();
  const TwoViewResult result = reconstruct(scene);
  EXPECT_FALSE(result.usable);
  EXPECT_THAT(result.refusal, HasSubstr("agree with one motion"));
}

TEST(TwoView, RefusesTooFewMatches) {
  const TwoViewResult result = reconstruct(SceneBuilder(2).count(20).build());
  EXPECT_FALSE(result.usable);
  EXPECT_EQ(result.refusal, "only 20 matches; 50 are needed");
  EXPECT_FALSE(reconstruct(SceneBuilder(2).count(0).build()).usable);
}

TEST(TwoView, PassesOverPixelsThatAreNotNumbers) {
  Scene scene = SceneBuilder(9).noise(0.5).build();
  for (std::size_t i = 0; i < scene.points.size(); i += 7) {
    scene.pixels2[i].x() = i % 2 ? std::numeric_limits<double>::quiet_NaN() : 1e300;
  }
  const TwoViewResult result = reconstruct(scene);
  ASSERT_TRUE(result.usable) << result.refusal;
  for (std::size_t i = 0; i < scene.points.size(); i += 7) EXPECT_FALSE(result.triangulated[i]);
  EXPECT_LT(rotation_error_deg(result.T_21, scene.T_21), 0.5);
}

TEST(TwoView, GivesTheSameAnswerForTheSameSeed) {
  const Scene scene = SceneBuilder(9).noise(1).outliers(0.3).build();
  const TwoViewResult a = reconstruct(scene, 5), b = reconstruct(scene, 5);
  EXPECT_EQ(a.T_21.translation(), b.T_21.translation());
  EXPECT_EQ(a.T_21.rotation().coeffs(), b.T_21.rotation().coeffs());
  EXPECT_EQ(a.triangulated, b.triangulated);
}

}  // namespace
}  // namespace cairn
