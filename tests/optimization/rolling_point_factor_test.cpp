#include "cairn/optimization/factors/rolling_point_factor.h"

#include <gtest/gtest.h>

#include "cairn/geometry/rolling_shutter.h"
#include "cairn/optimization/se3_manifold.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

struct Evaluated {
  Eigen::Vector2d e;
  Eigen::Matrix<double, 2, 7, Eigen::RowMajor> by_pose;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_point;
  Eigen::Vector2d by_readout;
};

Evaluated evaluate(const ceres::CostFunction& factor, const SE3& T_wc, const Eigen::Vector3d& X_w,
                   double readout) {
  double pose[7];
  SE3Manifold::pack(T_wc, pose);
  const double* blocks[] = {pose, X_w.data(), &readout};
  Evaluated result;
  double* jacobians[] = {result.by_pose.data(), result.by_point.data(), result.by_readout.data()};
  EXPECT_TRUE(factor.Evaluate(blocks, result.e.data(), jacobians));
  return result;
}

TEST(RollingPointFactor, AtTheAssumedReadoutItIsThePointFactor) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const SE3 T_wc = random.motion(3, 2);
    const Eigen::Vector3d X_w =
        T_wc * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 3);
    const Eigen::Vector2d pixel(random.uniform(0, 640), random.uniform(0, 480));
    const RollingPointFactor rolling(kCamera, pixel, 1.5, 0.02, {30, -20});
    const PointFactor at_once(kCamera, pixel, 1.5);
    const Evaluated a = evaluate(rolling, T_wc, X_w, 0.02), b = evaluate(at_once, T_wc, X_w, 0);
    EXPECT_LT((a.e - b.e).norm(), 1e-12);
    EXPECT_EQ(a.by_pose, b.by_pose);
    EXPECT_EQ(a.by_point, b.by_point);
  }
}

TEST(RollingPointFactor, DerivativeByTheReadoutAgreesWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T_wc = random.motion(3.1, random.uniform(0, 5));
    const Eigen::Vector3d X_w =
        T_wc * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 4);
    const RollingPointFactor factor(kCamera, {random.uniform(0, 640), random.uniform(0, 480)},
                                    random.uniform(0.5, 4), 0.01,
                                    {random.uniform(-300, 300), random.uniform(-300, 300)});
    const double at = random.uniform(-0.03, 0.03), h = 1e-4;
    const Eigen::Vector2d numeric =
        (evaluate(factor, T_wc, X_w, at + h).e - evaluate(factor, T_wc, X_w, at - h).e) / (2 * h);
    EXPECT_LT((evaluate(factor, T_wc, X_w, at).by_readout - numeric).norm(), 1e-6 * numeric.norm());
  }
}

// The drift is a slope: over all that readouts differ it is as good as a hundredth of a pixel.
TEST(RollingPointFactor, IsNearToTheShutterThatItStandsFor) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d X_mid(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 6));
    const Vector6d velocity = random.motion(0.5, 0.4).log();
    const double moment = random.uniform(-0.5, 0.5), true_readout = 0.025;
    const Eigen::Vector3d X_row = SE3::exp(moment * true_readout * velocity).inverse() * X_mid;
    const Eigen::Vector2d row = kCamera.project(X_row);
    constexpr double kStep = 0.01;
    const Eigen::Vector2d drift =
        (seen_at_once(kCamera, row, X_row.z(), moment, kStep * velocity) - row) / kStep;
    const RollingPointFactor factor(kCamera, row, 1, 0, drift);
    EXPECT_LT(evaluate(factor, SE3(), X_mid, true_readout).e.norm(), 0.02);
  }
}

}  // namespace
}  // namespace cairn
