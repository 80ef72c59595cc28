#include "cairn/mapping/point_fusion.h"

#include <gtest/gtest.h>

#include <set>

#include "map/links.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::broken_links;

class PointFusionTest : public ::testing::Test {
 protected:
  PointFusionTest() {
    std::vector<SE3> poses;
    for (int i = 0; i < 6; ++i) poses.push_back(along(0.15 * i));
    map = testing::true_map(world, poses);
    truth = map.points().size();
  }

  // Splits points that are seen often in two: one of the older keyframes, one of the newer ones.
  int split() {
    std::vector<PointId> often;
    map.points().for_each([&](PointId id, const MapPoint& p) {
      if (p.observations.size() >= 5) often.push_back(id);
    });
    for (const PointId id : often) {
      const auto seen = map.points()[id].observations;
      const PointId twin = map.add_point(map.points()[id].position + Eigen::Vector3d(0.003, 0, 0));
      for (std::size_t i = seen.size() / 2; i < seen.size(); ++i) {
        map.erase_observation(id, seen[i].keyframe);
        map.add_observation(twin, seen[i].keyframe, seen[i].keypoint);
      }
      for (const PointId p : {id, twin}) {
        map.update_descriptor(p);
        map.update_geometry(p);
      }
    }
    return static_cast<int>(often.size());
  }
  int mixed() const { return testing::errors_of(map, world).mixed; }

  testing::PointWorld world{81};
  Map map{testing::point_view()};
  std::size_t truth = 0;
};

TEST_F(PointFusionTest, MergesPointsThatAreOneInTheNeighbourhood) {
  const int twins = split();
  ASSERT_GT(twins, 100);
  EXPECT_GT(fuse_neighbourhood(map, map.newest(), 20), twins / 2);
  EXPECT_EQ(broken_links(map), "");
  EXPECT_LT(map.points().size(), truth + twins / 5);
  EXPECT_LE(mixed(), 2) << "different points became one";
}

TEST_F(PointFusionTest, MergesPointsThatAreOneEverywhere) {
  const int twins = split();
  fuse_everywhere(map);
  EXPECT_EQ(broken_links(map), "");
  EXPECT_LT(map.points().size(), truth + twins / 10);
  EXPECT_LE(mixed(), 2);
}

TEST_F(PointFusionTest, FindsKeypointsThatWereOverlooked) {
  int erased = 0;
  std::vector<PointId> points;
  map.points().for_each([&](PointId id, const MapPoint& p) {
    points.push_back(id);
    if (p.observations.size() < 4 || map.keypoint_of(id, map.newest()) < 0) return;
    map.erase_observation(id, map.newest());
    ++erased;
  });
  ASSERT_GT(erased, 100);
  const int found = fuse_into(map, map.newest(), points, 3);
  EXPECT_GT(found, 0.8 * erased);
  EXPECT_EQ(broken_links(map), "");
  EXPECT_LE(mixed(), 2);
}

TEST_F(PointFusionTest, LeavesPointsAloneThatAreFarFromTheKeypointThatLooksLikeThem) {
  std::vector<PointId> strayed;
  map.points().for_each([&](PointId id, const MapPoint&) {
    const int keypoint = map.keypoint_of(id, map.newest());
    if (keypoint < 0 || map.points()[id].observations.size() < 4) return;
    map.erase_observation(id, map.newest());
    map.points()[id].position += Eigen::Vector3d(0.5, 0.3, 0);
    strayed.push_back(id);
  });
  fuse_into(map, map.newest(), strayed, 3);
  int linked = 0;
  for (const PointId p : strayed) linked += map.keypoint_of(p, map.newest()) >= 0;
  EXPECT_LE(linked, static_cast<int>(strayed.size()) / 50);
}

TEST_F(PointFusionTest, PointsThatAreGoneAreIgnored) {
  const PointId gone = map.add_point({0, 0, 5});
  map.erase_point(gone);
  EXPECT_EQ(fuse_into(map, map.newest(), {{gone}}, 3), 0);
}

}  // namespace
}  // namespace cairn
