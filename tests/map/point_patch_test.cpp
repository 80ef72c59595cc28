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

// The wall is seen at half a right angle, then from straight ahead.
TEST(PointPatch, IsFoundFromTheOtherSideWhereItsFacetLiesAsTheSurfaceDoes) {
  const PaintedWall wall;
  const auto from_aside = [](double yaw) {
    const SE3 turn(so3_exp({0, yaw, 0}), Eigen::Vector3d::Zero());
    return SE3(turn.rotation(), kPoint - turn * Eigen::Vector3d(0, 0, 1.8));
  };
  const SE3 seen = from_aside(0.8), from = from_aside(0);
  const auto facing =
      cut_patch(wall.show(seen), wall.pinhole(), wall.pixel(seen, kPoint), 0, seen, kPoint);
  ASSERT_TRUE(facing);
  const Eigen::Vector2d truth = wall.pixel(from, kPoint);
  const auto off = [&](const PointPatch& patch) {
    const auto found = find_patch(patch, wall.show(from), wall.pinhole(), from.inverse(), kPoint,
                                  truth + Eigen::Vector2d(0.5, 0.4));
    return found ? (*found - truth).norm() : 10;
  };
  EXPECT_LT(off(facing->turned(Eigen::Vector3d::UnitZ())), 0.12);
  EXPECT_GT(off(*facing), 0.25);
  EXPECT_EQ(facing->turned(Eigen::Vector3d::UnitY()).steps, facing->steps);  // nearly an edge
}

TEST(PointPatch, OnAFacetItsPixelsLieWhereTheirRaysMeetTheFacet) {
  const PaintedWall wall;
  const SE3 seen(so3_exp({0.1, -0.2, 0.3}), Eigen::Vector3d(0.1, 0.05, 0.2));
  const Eigen::Vector2d pixel = wall.pixel(seen, kPoint);
  const auto facing = cut_patch(wall.show(seen), wall.pinhole(), pixel, 0, seen, kPoint);
  ASSERT_TRUE(facing);
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(2, 1, 1), Eigen::Vector3d(-0.5, 0.5, 1)}) {
    const PointPatch patch = facing->turned({0.3, -1, 1.5}).turned(normal);
    for (const Eigen::Vector2d& u : {Eigen::Vector2d(4, 4), Eigen::Vector2d(-4, 3)}) {
      const auto at = [&](const PointPatch& p) -> Eigen::Vector3d {
        return kPoint + p.steps * u / (1 + p.foreshortening.dot(u));
      };
      EXPECT_NEAR(normal.normalized().dot(at(patch) - kPoint), 0, 1e-12);
      EXPECT_NEAR((wall.pixel(seen, at(patch)) - wall.pixel(seen, at(*facing))).norm(), 0, 1e-9);
    }
  }
}

TEST(PointPatch, IsNotCutAtTheBorder) {
  const PaintedWall wall;
  EXPECT_FALSE(cut_patch(wall.show(SE3()), wall.pinhole(), {-30, 118}, 0, SE3(), kPoint));
}

}  // namespace
}  // namespace cairn
