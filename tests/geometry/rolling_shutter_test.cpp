#include "cairn/geometry/rolling_shutter.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

TEST(RollingShutter, IsUndoneWhereDepthAndMotionAreKnown) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d X_mid(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 6));
    const Vector6d motion = random.motion(0.05, 0.02).log();
    const double moment = random.uniform(-0.5, 0.5);
    // The camera while the row was read, seen from where it was in the middle of the picture.
    const Eigen::Vector3d X_row = SE3::exp(moment * motion).inverse() * X_mid;
    const Eigen::Vector2d pixel =
        seen_at_once(kCamera, kCamera.project(X_row), X_row.z(), moment, motion);
    EXPECT_LT((pixel - kCamera.project(X_mid)).norm(), 1e-9);
  }
}

TEST(RollingShutter, MovesNothingInTheMiddleRowOrWhileTheCameraIsStill) {
  const Eigen::Vector2d pixel(123, 45);
  const Vector6d motion = (Vector6d() << 0.01, 0, 0, 0, 0.02, 0).finished();
  EXPECT_LT((seen_at_once(kCamera, pixel, 2, 0, motion) - pixel).norm(), 1e-12);
  EXPECT_LT((seen_at_once(kCamera, pixel, 2, 0.4, Vector6d::Zero()) - pixel).norm(), 1e-12);
}

TEST(RollingShutter, MovesTheFarAwayOnlyByRotation) {
  Vector6d motion = (Vector6d() << 0.1, 0.05, 0, 0, 0, 0).finished();
  const Eigen::Vector2d pixel(123, 45);
  EXPECT_LT((seen_at_once(kCamera, pixel, INFINITY, -0.4, motion) - pixel).norm(), 1e-12);
  motion[4] = 0.02;
  EXPECT_GT((seen_at_once(kCamera, pixel, INFINITY, -0.4, motion) - pixel).norm(), 1);
}

TEST(RollingShutter, LeavesAloneWhatWouldBeBehindTheCamera) {
  const Vector6d motion = (Vector6d() << 0, 0, -3, 0, 0, 0).finished();
  const Eigen::Vector2d pixel(123, 45);
  EXPECT_EQ(seen_at_once(kCamera, pixel, 1, 0.5, motion), pixel);
}

}  // namespace
}  // namespace cairn
