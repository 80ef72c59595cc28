#include "cairn/mapping/plane_roughness.h"

#include <gtest/gtest.h>

#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::few_poses;
using testing::points_of;
using testing::Random;

constexpr double kZ = 4;  // of the wall

// A wall whose points stand off it by this much, and are where pictures show them up to `noise`.
struct Wall {
  explicit Wall(double relief, double noise, int count = 300) {
    Random random(71);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(-1.5, 1.5), y = random.uniform(-1, 1);
      points.emplace_back(x, y, kZ + relief * random.gaussian());
    }
    map = testing::map_of(points, few_poses(6), noise, 72);
    id = map.add_plane(map.first(),
                       testing::seen_from(few_poses(1).front(), testing::wall_corners()));
    for (const PointId p : points_of(map)) map.set_plane_of(p, id);
  }

  Map map{testing::point_view()};
  PlaneId id;
};

TEST(PlaneRoughness, IsHowFarPointsStandOffASurface) {
  for (const double relief : {0.06, 0.1, 0.2}) {
    const Wall wall(relief, 0.5);
    EXPECT_NEAR(plane_roughness(wall.map, wall.id), relief / kZ, 0.2 * relief / kZ) << relief;
  }
}

TEST(PlaneRoughness, IsNotWhatItsPointsErr) {
  const Wall flat(0, 0.6), rough(0.04, 0.6);
  EXPECT_LT(plane_roughness(flat.map, flat.id), 0.002);
  EXPECT_NEAR(plane_roughness(rough.map, rough.id), 0.01, 0.003);
}

TEST(PlaneRoughness, DoesNotGoWhenPointsAreDrawnOntoThePlane) {
  Wall wall(0.1, 0.5);
  const double before = plane_roughness(wall.map, wall.id);
  for (const PointId p : points_of(wall.map)) {
    Eigen::Vector3d& X = wall.map.points()[p].position;
    X *= kZ / X.z();
  }
  EXPECT_GT(plane_roughness(wall.map, wall.id), 0.7 * before);
}

TEST(PlaneRoughness, OfAFewPointsIsTheirSpread) {
  const Wall few(0.05, 0.1, 8), none(0, 0, 0);
  EXPECT_GT(plane_roughness(few.map, few.id), 0.003);
  EXPECT_EQ(plane_roughness(none.map, none.id), 1);
}

}  // namespace
}  // namespace cairn
