#include "cairn/optimization/pose_adjustment.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

struct Sights {
  SE3 T_wc;  // the truth
  std::vector<PoseObservation> observations;
  std::vector<char> is_outlier;
};

Sights make_sights(std::uint64_t seed, int count, double noise, double outliers) {
  Random random(seed);
  Sights sights;
  sights.T_wc = random.motion(3, 5);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(random.uniform(0, 640), random.uniform(0, 480));
    const double sigma = std::pow(1.2, random.below(8));
    const Eigen::Vector3d X_c = kCamera.unproject(pixel) * random.uniform(1.5, 8);
    const double dx = random.gaussian(), dy = random.gaussian();
    const bool outlier = std::floor((i + 1) * outliers) > std::floor(i * outliers);
    Eigen::Vector2d seen = pixel + noise * sigma * Eigen::Vector2d(dx, dy);
    if (outlier) {
      const double angle = random.uniform(0, 2 * M_PI), distance = random.uniform(40, 200);
      seen += distance * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    sights.observations.push_back({sights.T_wc * X_c, seen, sigma});
    sights.is_outlier.push_back(outlier);
  }
  return sights;
}

TEST(PoseAdjustment, RecoversADisplacedPoseExactlyFromExactSights) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Sights sights = make_sights(seed, 100, 0, 0);
    SE3 T_wc = sights.T_wc * Random(seed + 100).motion(0.1, 0.2);
    std::vector<char> inlier;
    const auto summary = adjust_pose(sights.observations, kCamera, T_wc, inlier);
    ASSERT_TRUE(summary.usable) << seed;
    EXPECT_EQ(summary.inliers, 100);
    EXPECT_LT((T_wc.inverse() * sights.T_wc).log().norm(), 1e-5) << seed;
  }
}

TEST(PoseAdjustment, NoiseMovesThePoseALittleAndTheRmsTellsIt) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Sights sights = make_sights(seed, 300, 1, 0);
    SE3 T_wc = sights.T_wc * Random(seed + 100).motion(0.05, 0.1);
    std::vector<char> inlier;
    const auto summary = adjust_pose(sights.observations, kCamera, T_wc, inlier);
    ASSERT_TRUE(summary.usable);
    EXPECT_GT(summary.inliers, 260);
    EXPECT_GT(summary.rms, 0.9);
    EXPECT_LT(summary.rms, 1.6);
    EXPECT_LT((T_wc.inverse() * sights.T_wc).log().norm(), 0.02);
  }
}

// Three walls of a room as one picture shows them, exactly.
PoseSupport walls_around(const SE3& T_wc, double sigma_angle, double sigma_offset) {
  PoseSupport support;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d normal = Eigen::Vector3d::Constant(0.3);
    normal[axis] = -1;
    const Plane in_camera(normal.normalized(), 2.5);
    const Eigen::Vector3d centroid = -in_camera.offset() * in_camera.normal();
    support.planes.emplace_back(
        FactorForm::kRobust,
        PlaneMeasurement::isotropic(in_camera.normal(), centroid, sigma_angle, sigma_offset),
        in_camera.transformed(T_wc));
  }
  return support;
}

TEST(PoseAdjustment, ThreeWallsHoldACameraThatSeesNoPoint) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SE3 truth = Random(seed).motion(3, 5);
    PoseSupport support = walls_around(truth, 0.02, 0.02);
    SE3 T_wc = truth * Random(seed + 100).motion(0.1, 0.2);
    support.prior = {T_wc, Vector6d::Constant(10)};
    std::vector<char> inlier;
    const auto summary = adjust_pose({}, kCamera, T_wc, inlier, &support);
    EXPECT_TRUE(summary.usable);
    EXPECT_EQ(summary.inliers, 0);
    EXPECT_LT((T_wc.inverse() * truth).log().norm(), 1e-3) << seed;
  }
}

TEST(PoseAdjustment, TheExpectedMotionHoldsWhatNothingElseSays) {
  const SE3 expected = Random(7).motion(1, 2);
  PoseSupport support;
  support.prior = {expected, Vector6d::Constant(0.1)};
  SE3 T_wc = expected * Random(8).motion(0.1, 0.1);
  std::vector<char> inlier;
  EXPECT_TRUE(adjust_pose({}, kCamera, T_wc, inlier, &support).usable);
  EXPECT_LT((T_wc.inverse() * expected).log().norm(), 1e-6);
}

TEST(PoseAdjustment, ManyPointsAreStrongerThanAWrongExpectation) {
  const Sights sights = make_sights(3, 200, 0, 0);
  PoseSupport support;
  support.prior = {sights.T_wc * Random(9).motion(0.05, 0.1), Vector6d::Constant(0.3)};
  SE3 T_wc = support.prior.T_wc;
  std::vector<char> inlier;
  EXPECT_TRUE(adjust_pose(sights.observations, kCamera, T_wc, inlier, &support).usable);
  EXPECT_LT((T_wc.inverse() * sights.T_wc).log().norm(), 0.002);
}

// While its rows are read, the camera moves otherwise than it does from frame to frame.
TEST(PoseAdjustment, FindsTheMotionOfARollingShutterWithThePose) {
  constexpr double kReadout = 0.025;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random random(seed + 200);
    Sights sights = make_sights(seed, 300, 0.2, 0.1);
    const Vector6d velocity = random.motion(0.4, 0.4).log();
    const Vector6d tremor = 0.1 * random.motion(1, 1).log().normalized();
    for (PoseObservation& o : sights.observations) {
      o.moment = o.pixel.y() / 480 - 0.5;
      const Eigen::Vector3d X = sights.T_wc.inverse() * o.position;
      o.pixel += kCamera.project(SE3::exp(-o.moment * kReadout * tremor) * X) - kCamera.project(X);
    }
    SE3 T_wc = sights.T_wc * Random(seed + 100).motion(0.03, 0.05);
    SE3 without = T_wc;
    std::vector<char> inlier;
    ShutterMotion shutter = expected_motion(kReadout, velocity, 5);
    ASSERT_TRUE(adjust_pose(sights.observations, kCamera, T_wc, inlier, nullptr, &shutter).usable);
    ASSERT_TRUE(adjust_pose(sights.observations, kCamera, without, inlier).usable);
    const auto turned = [&](const SE3& pose) {
      return (pose.inverse() * sights.T_wc).log().tail<3>().norm();
    };
    EXPECT_LT(turned(T_wc), 0.0012) << seed;
    EXPECT_GT(turned(without) + 0.0003, turned(T_wc)) << seed;
    const Vector6d truth = kReadout * (velocity + tremor);
    EXPECT_LT((shutter.motion - truth).tail<3>().norm(), 0.4 * kReadout * tremor.norm()) << seed;
  }
}

TEST(PoseAdjustment, MarksOutliersAndIsNotMovedByThem) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Sights sights = make_sights(seed, 200, 0.5, 0.3);
    SE3 T_wc = sights.T_wc * Random(seed + 100).motion(0.03, 0.05);
    std::vector<char> inlier;
    const auto summary = adjust_pose(sights.observations, kCamera, T_wc, inlier);
    ASSERT_TRUE(summary.usable);
    ASSERT_EQ(inlier.size(), sights.observations.size());
    int kept = 0, marked = 0, wrong = 0;
    for (std::size_t i = 0; i < inlier.size(); ++i) {
      kept += inlier[i];
      marked += !inlier[i] && sights.is_outlier[i];
      wrong += static_cast<bool>(inlier[i]) == static_cast<bool>(sights.is_outlier[i]);
    }
    EXPECT_EQ(kept, summary.inliers);
    EXPECT_EQ(marked, 60) << "an outlier was taken for good";
    EXPECT_LE(wrong, 8);
    EXPECT_LT((T_wc.inverse() * sights.T_wc).log().norm(), 0.02);
  }
}

TEST(PoseAdjustment, RefusesFewerThanThreePointsAndLeavesThePoseAlone) {
  for (int count : {0, 1, 2}) {
    const Sights sights = make_sights(1, count, 0, 0);
    const SE3 start = sights.T_wc * Random(2).motion(0.05, 0.1);
    SE3 T_wc = start;
    std::vector<char> inlier;
    EXPECT_FALSE(adjust_pose(sights.observations, kCamera, T_wc, inlier).usable);
    EXPECT_EQ((T_wc.matrix() - start.matrix()).norm(), 0);
    EXPECT_EQ(inlier.size(), sights.observations.size());
  }
}

TEST(PoseAdjustment, RefusesPointsThatAreAllBehindTheCamera) {
  const Sights sights = make_sights(3, 50, 0, 0);
  SE3 T_wc = sights.T_wc * SE3(so3_exp({0, M_PI, 0}), Eigen::Vector3d::Zero());
  std::vector<char> inlier;
  EXPECT_FALSE(adjust_pose(sights.observations, kCamera, T_wc, inlier).usable);
}

TEST(PoseAdjustment, NumbersThatAreNotFiniteNeverReachThePose) {
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  const double kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {kNaN, kInf, -kInf}) {
    for (int where = 0; where < 2; ++where) {
      Sights sights = make_sights(5, 50, 0.5, 0);
      if (where == 0) sights.observations[7].position.x() = bad;
      if (where == 1) sights.observations[7].pixel.y() = bad;
      SE3 T_wc = sights.T_wc;
      std::vector<char> inlier;
      const auto summary = adjust_pose(sights.observations, kCamera, T_wc, inlier);
      EXPECT_TRUE(T_wc.is_finite());
      EXPECT_TRUE(std::isfinite(summary.rms));
      if (summary.usable) {
        EXPECT_FALSE(inlier[7]);
      }
    }
  }
  const Sights sights = make_sights(6, 50, 0.5, 0);
  SE3 T_wc(Eigen::Quaterniond::Identity(), Eigen::Vector3d::Constant(kNaN));
  std::vector<char> inlier;
  EXPECT_FALSE(adjust_pose(sights.observations, kCamera, T_wc, inlier).usable);
}

}  // namespace
}  // namespace cairn
