#include "cairn/mapping/point_creation.h"

#include <gtest/gtest.h>

#include "map/links.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;

// A true map that has lost two points of three.
Map sparse_map(testing::PointWorld& world, const std::vector<SE3>& poses) {
  Map map = testing::true_map(world, poses);
  map.points().for_each([&](PointId id, const MapPoint&) {
    if (id.slot % 3 != 0) map.erase_point(id);
  });
  return map;
}

TEST(PointCreation, MakesPointsNearTheTruthFromFreeKeypoints) {
  testing::PointWorld world(71);
  Map map = sparse_map(world, {along(0), along(0.4), along(0.8)});
  const std::size_t before = map.points().size();
  const std::vector<PointId> created = create_points(map, map.newest(), {});
  EXPECT_EQ(map.points().size(), before + created.size());
  EXPECT_GT(created.size(), 150u);
  EXPECT_EQ(testing::broken_links(map), "");
  const Eigen::Vector3d camera = map.keyframes()[map.newest()].T_wc.translation();
  std::size_t right = 0, near = 0;
  for (const PointId id : created) {
    const MapPoint& p = map.points()[id];
    EXPECT_EQ(p.observations.size(), 2u);
    EXPECT_GT(p.base_distance, 0);
    EXPECT_NEAR(p.normal.norm(), 1, 1e-5);
    const int index = world.point_of(map, p);
    if (index < 0) continue;
    ++right;
    const Eigen::Vector3d truth = world.position(index);
    near += (p.position - truth).norm() < 0.08 * (truth - camera).norm();
  }
  EXPECT_GT(right, 0.95 * created.size()) << "different points were taken for one";
  EXPECT_GT(near, 0.85 * created.size());
}

TEST(PointCreation, NeedsParallax) {
  testing::PointWorld world(72);
  const SE3 turned(so3_exp({0, 0.05, 0}), Eigen::Vector3d(0.005, 0, 0));
  Map map = sparse_map(world, {along(0), turned});
  EXPECT_TRUE(create_points(map, map.newest(), {}).empty());
}

TEST(PointCreation, LeavesKeypointsAloneThatHaveAPoint) {
  testing::PointWorld world(73);
  Map map = sparse_map(world, {along(0), along(0.4)});
  const std::vector<PointId> before = map.keyframes()[map.newest()].points;
  create_points(map, map.newest(), {});
  const std::vector<PointId>& after = map.keyframes()[map.newest()].points;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].valid()) {
      EXPECT_EQ(after[i], before[i]);
    }
  }
}

}  // namespace
}  // namespace cairn
