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
    poses.reserve(6);
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

// One point of the map as two that meet in the newest keyframe: one that the first two keyframes
// saw, and one of all others, `shift` nearer to the newest keyframe (share of the distance).
struct Twins {
  PointId older, newer;
};
Twins twins_of(Map& map, PointId id, double shift) {
  const auto seen = map.points()[id].observations;
  const Eigen::Vector3d X = map.points()[id].position;
  const Eigen::Vector3d camera = map.keyframes()[map.newest()].T_wc.translation();
  const Twins twins{id, map.add_point(X + shift * (camera - X))};
  for (std::size_t i = 2; i < seen.size(); ++i) {
    map.erase_observation(id, seen[i].keyframe);
    map.add_observation(twins.newer, seen[i].keyframe, seen[i].keypoint);
  }
  for (const PointId p : {twins.older, twins.newer}) {
    map.update_descriptor(p);
    map.update_geometry(p);
  }
  return twins;
}

std::vector<PointId> seen_by_all(const Map& map) {
  std::vector<PointId> points;
  map.points().for_each([&](PointId id, const MapPoint& p) {
    if (p.observations.size() == map.keyframes().size()) points.push_back(id);
  });
  return points;
}

TEST_F(PointFusionTest, PointsThatMeetInOneKeyframeAloneStayTwo) {
  int pairs = 0, merged = 0;
  for (const PointId id : seen_by_all(map)) {
    const Twins twins = twins_of(map, id, 0.4);
    ++pairs;
    fuse_into(map, map.newest(), {{twins.older}}, 3);
    merged += !map.points().contains(twins.older);
  }
  ASSERT_GT(pairs, 50);
  EXPECT_EQ(merged, 0);
  EXPECT_EQ(broken_links(map), "");
}

TEST_F(PointFusionTest, WhatSawAPointElsewhereIsLeftOutOfTheMerger) {
  const PointId id = seen_by_all(map).front();
  const Twins twins = twins_of(map, id, 0);
  const Observation moved = map.points()[id].observations[1];
  Keyframe& keyframe = map.keyframes()[moved.keyframe];
  std::uint32_t elsewhere = 0;  // a keypoint of nobody, far off
  while (keyframe.points[elsewhere].valid() ||
         (keyframe.frame->pixel(elsewhere) - keyframe.frame->pixel(moved.keypoint)).norm() < 50) {
    ASSERT_LT(++elsewhere, keyframe.points.size());
  }
  keyframe.points[moved.keypoint] = {};
  keyframe.points[elsewhere] = id;
  map.points()[id].observations[1].keypoint = elsewhere;
  ASSERT_EQ(fuse_into(map, map.newest(), {{id}}, 3), 1);
  EXPECT_FALSE(map.points().contains(id));
  EXPECT_GE(map.keypoint_of(twins.newer, map.first()), 0) << "the other one is as good as before";
  EXPECT_EQ(map.keypoint_of(twins.newer, moved.keyframe), -1);
  EXPECT_EQ(broken_links(map), "");
}

TEST_F(PointFusionTest, PointsThatAreGoneAreIgnored) {
  const PointId gone = map.add_point({0, 0, 5});
  map.erase_point(gone);
  EXPECT_EQ(fuse_into(map, map.newest(), {{gone}}, 3), 0);
}

}  // namespace
}  // namespace cairn
