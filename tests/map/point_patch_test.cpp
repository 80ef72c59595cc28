#include "cairn/map/point_patch.h"

#include <gtest/gtest.h>

#include "map/painted_wall.h"

namespace cairn {
namespace {

using testing::PaintedWall;

const Eigen::Vector3d kPoint(0.31, -0.2, PaintedWall::kZ);

std::shared_ptr<const PointPatch> patch_seen_from_origin(const PaintedWall& wall, int octave) {
  return cut_patch(wall.show(SE3()), wall.pinhole(), wall.pixel(SE3(), kPoint), octave, SE3(),
                   kPoint);
}

TEST(PointPatch, IsFoundFromAnotherPlaceThroughABentLens) {
  const PaintedWall wall;
  for (const int octave : {0, 2}) {
    const auto patch = patch_seen_from_origin(wall, octave);
    ASSERT_TRUE(patch);
    for (const SE3& T_wc : {SE3(so3_exp({0.02, -0.03, 0.3}), Eigen::Vector3d(0.1, 0.05, 0.2)),
                            SE3(so3_exp({-0.05, 0.04, -0.2}), Eigen::Vector3d(-0.1, 0.1, -0.4))}) {
      const Eigen::Vector2d truth = wall.pixel(T_wc, kPoint);
      const auto found = find_patch(*patch, wall.show(T_wc), wall.pinhole(), T_wc.inverse(), kPoint,
                                    truth + Eigen::Vector2d(0.7, -0.6));
      ASSERT_TRUE(found) << octave;
      EXPECT_LT((*found - truth).norm(), 0.12) << octave;
    }
  }
}

TEST(PointPatch, IsNotLookedForBehindTheCameraFromAfarOrFromAside) {
  const PaintedWall wall;
  const auto patch = patch_seen_from_origin(wall, 0);
  ASSERT_TRUE(patch);
  const Picture picture = wall.show(SE3());
  const auto looked_for_from = [&](const SE3& T_wc) {
    return find_patch(*patch, picture, wall.pinhole(), T_wc.inverse(), kPoint, {160, 120});
  };
  EXPECT_FALSE(looked_for_from(SE3(so3_exp({0, 0, 0}), Eigen::Vector3d(0, 0, 3))));
  EXPECT_FALSE(looked_for_from(SE3(so3_exp({0, 0, 0}), Eigen::Vector3d(0, 0, -20))));
  EXPECT_FALSE(looked_for_from(SE3(so3_exp({0, 1.45, 0}), kPoint - Eigen::Vector3d(1.99, 0, 0.2))));
}

TEST(PointPatch, IsNotCutAtTheBorder) {
  const PaintedWall wall;
  EXPECT_FALSE(cut_patch(wall.show(SE3()), wall.pinhole(), {-30, 118}, 0, SE3(), kPoint));
}

}  // namespace
}  // namespace cairn
