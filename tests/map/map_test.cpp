#include "cairn/map/map.h"

#include <gtest/gtest.h>

#include "map/flat_map.h"
#include "map/links.h"
#include "map/plain_frame.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::broken_links;
using testing::plain_frame;
using testing::PointWorld;
using testing::Random;
using testing::true_map;

const std::vector<SE3> kWalk = {along(0), along(0.3), along(0.6), along(0.9), along(1.2)};

PointId any_point(const Map& map, Random& random) {
  std::vector<PointId> ids;
  map.points().for_each([&](PointId id, const MapPoint&) { ids.push_back(id); });
  return ids.empty() ? PointId() : ids[random.below(static_cast<int>(ids.size()))];
}

TEST(Map, LinksStayConsistentUnderRandomOperations) {
  PointWorld world(11);
  Map map = true_map(world, kWalk);
  ASSERT_EQ(broken_links(map), "");
  Random random(5);
  double time = 10;
  for (int step = 0; step < 1500 && map.points().size() > 20; ++step) {
    const PointId p = any_point(map, random), q = any_point(map, random);
    const int what = random.below(100);
    if (what < 40) {
      const auto seen = map.points()[p].observations;
      map.erase_observation(p, seen[random.below(static_cast<int>(seen.size()))].keyframe);
    } else if (what < 60) {
      map.erase_point(p);
    } else if (what < 95) {
      if (p != q) map.merge_points(p, q);
    } else if (what < 97) {
      const auto ids = testing::keyframes_of(map);
      if (ids.size() > 4) map.erase_keyframe(ids[random.below(static_cast<int>(ids.size()))]);
    } else {
      const auto frame = world.show(along(random.uniform(0, 1.5)), time += 1);
      const auto points = testing::true_points(world, map, *frame);
      const KeyframeId id = map.add_keyframe(frame, world.truth(*frame));
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (points[i].valid()) map.add_observation(points[i], id, i);
      }
    }
    ASSERT_EQ(broken_links(map), "") << "after step " << step;
  }
}

TEST(Map, AnotherReadoutMovesKeypointsByTheDepthOfTheirPoints) {
  const std::vector<Vector6d> velocities(5, (Vector6d() << 0.5, 0, 0, 0, 0.4, 0).finished());
  PointWorld world(12, {.noise = 0, .clutter = 0, .readout = 0.025});
  Map map = true_map(world, kWalk, velocities);
  double rolled = 0, unrolled = 0;
  const auto worst = [&] {
    double worst = 0;
    map.points().for_each([&](PointId, const MapPoint& p) {
      for (const Observation& o : p.observations) {
        const Keyframe& k = map.keyframes()[o.keyframe];
        const Eigen::Vector2d at = map.view().pinhole().project(k.T_wc.inverse() * p.position);
        worst = std::max(worst, (at - k.frame->pixel(o.keypoint)).norm());
      }
    });
    return worst;
  };
  rolled = worst();
  map.set_readout(0.025);
  unrolled = worst();
  EXPECT_GT(rolled, 1);
  EXPECT_LT(unrolled, 0.02);
  map.set_readout(0.003);  // as good as none
  EXPECT_EQ(map.readout(), 0);
  EXPECT_EQ(map.readout_estimate(), 0.003);
  EXPECT_NEAR(worst(), rolled, 1e-9);
}

TEST(Map, APointThatFewerThanTwoKeyframesSeeVanishes) {
  Map map(testing::point_view());
  const KeyframeId a = map.add_keyframe(plain_frame(3), SE3());
  const KeyframeId b = map.add_keyframe(plain_frame(3), SE3());
  const PointId p = map.add_point({0, 0, 1});
  map.add_observation(p, a, 1);
  map.add_observation(p, b, 2);
  EXPECT_EQ(map.keypoint_of(p, b), 2);
  map.erase_observation(p, b);
  EXPECT_FALSE(map.points().contains(p));
  EXPECT_FALSE(map.keyframes()[a].points[1].valid());
}

TEST(Map, APointGoesWithTheKeyframeThatNobodyElseSharesItWith) {
  Map map(testing::point_view());
  const KeyframeId a = map.add_keyframe(plain_frame(2), SE3());
  const KeyframeId b = map.add_keyframe(plain_frame(2), SE3());
  const KeyframeId c = map.add_keyframe(plain_frame(2), SE3());
  const PointId two = map.add_point({0, 0, 1}), three = map.add_point({0, 0, 2});
  for (const KeyframeId k : {a, b}) map.add_observation(two, k, 0);
  for (const KeyframeId k : {a, b, c}) map.add_observation(three, k, 1);
  map.erase_keyframe(b);
  EXPECT_FALSE(map.points().contains(two));
  ASSERT_TRUE(map.points().contains(three));
  EXPECT_EQ(map.points()[three].observations.size(), 2u);
  EXPECT_EQ(broken_links(map), "");
}

TEST(Map, MergingKeepsOneKeypointAKeyframe) {
  Map map(testing::point_view());
  const KeyframeId a = map.add_keyframe(plain_frame(4), SE3());
  const KeyframeId b = map.add_keyframe(plain_frame(4), SE3());
  const KeyframeId c = map.add_keyframe(plain_frame(4), SE3());
  const PointId from = map.add_point({0, 0, 1}), into = map.add_point({0, 0, 1.01});
  for (const KeyframeId k : {a, b}) map.add_observation(from, k, 0);
  for (const KeyframeId k : {b, c}) map.add_observation(into, k, 1);
  map.merge_points(from, into);
  EXPECT_FALSE(map.points().contains(from));
  EXPECT_EQ(map.keypoint_of(into, a), 0);
  EXPECT_EQ(map.keypoint_of(into, b), 1);
  EXPECT_FALSE(map.keyframes()[b].points[0].valid());
  EXPECT_EQ(broken_links(map), "");
}

TEST(Map, CovisibleKeyframesComeByWhatTheyShareThenByAge) {
  Map map(testing::point_view());
  const KeyframeId centre = map.add_keyframe(plain_frame(10), SE3());
  const KeyframeId old = map.add_keyframe(plain_frame(10), SE3());
  const KeyframeId most = map.add_keyframe(plain_frame(10), SE3());
  const KeyframeId young = map.add_keyframe(plain_frame(10), SE3());
  const KeyframeId hardly = map.add_keyframe(plain_frame(10), SE3());
  map.add_keyframe(plain_frame(10), SE3());  // shares nothing
  for (std::uint32_t i = 0; i < 6; ++i) {
    const PointId p = map.add_point({0, 0, 1});
    map.add_observation(p, centre, i);
    map.add_observation(p, most, i);
    if (i < 3) map.add_observation(p, young, i);
    if (i >= 3) map.add_observation(p, old, i);
    if (i == 0) map.add_observation(p, hardly, i);
  }
  using Shared = std::vector<std::pair<KeyframeId, int>>;
  EXPECT_EQ(map.covisible(centre, 2), (Shared{{most, 6}, {old, 3}, {young, 3}}));
  EXPECT_EQ(map.covisible(centre, 1).back(), std::pair(hardly, 1));
  EXPECT_EQ(map.covisible(centre, 1, 2), (Shared{{most, 6}, {old, 3}}));
  EXPECT_EQ(broken_links(map), "");
}

TEST(Map, GeometryOfAPointIsTheMeanOfItsViews) {
  PointWorld world(3);
  Map map = true_map(world, kWalk);
  map.points().for_each([&](PointId id, const MapPoint& p) {
    EXPECT_NEAR(p.normal.norm(), 1, 1e-5);
    double closest = INFINITY, farthest = 0;  // at which it would show in octave 0
    for (const Observation& o : p.observations) {
      const Keyframe& k = map.keyframes()[o.keyframe];
      const Eigen::Vector3d ray = p.position - k.T_wc.translation();
      EXPECT_GT(ray.normalized().dot(p.normal.cast<double>()), 0.9);
      const double base = ray.norm() * map.view().scale(k.frame->octave(o.keypoint));
      closest = std::min(closest, base);
      farthest = std::max(farthest, base);
    }
    EXPECT_GE(p.base_distance, closest * 0.999) << id.slot;
    EXPECT_LE(p.base_distance, farthest * 1.001) << id.slot;
  });
}

TEST(Map, AReprojectionErrorLeadsFromTheKeypointToThePointAndIsInfiniteBehindTheCamera) {
  const Map map =
      testing::map_of(testing::grid_on(testing::wall_corners(), 5), testing::few_poses(4));
  map.points().for_each([&](PointId, const MapPoint& p) {
    const Observation& o = p.observations.front();
    const Keyframe& k = map.keyframes()[o.keyframe];
    EXPECT_LT(map.reprojection_error(o.keyframe, o.keypoint, p.position).norm(), 1e-3);
    const Eigen::Vector3d right = k.T_wc.rotation() * Eigen::Vector3d::UnitX();
    EXPECT_GT(map.reprojection_error(o.keyframe, o.keypoint, p.position + 0.1 * right).x(), 0.1);
    const Eigen::Vector3d behind = 2 * k.T_wc.translation() - p.position;
    EXPECT_EQ(map.reprojection_error(o.keyframe, o.keypoint, behind).norm(), INFINITY);
  });
}

TEST(Map, DescriptorOfAPointIsTheTypicalOneOfItsObservations) {
  Map map(testing::point_view());
  const PointId p = map.add_point({0, 0, 1});
  const std::vector<Descriptor> seen = {{0b0111}, {0b0011}, {~std::uint64_t{0}}, {0b0001}};
  for (const Descriptor& d : seen) {
    auto frame = plain_frame(1);
    frame->features.descriptors[0] = d;
    map.add_observation(p, map.add_keyframe(frame, SE3()), 0);
  }
  map.update_descriptor(p);
  EXPECT_EQ(map.points()[p].descriptor, Descriptor{0b0011});
}

TEST(Map, DepthQuantilesAreThoseOfThePointsSeen) {
  Map map(testing::point_view());
  const KeyframeId a = map.add_keyframe(plain_frame(5), SE3());
  const KeyframeId b = map.add_keyframe(plain_frame(5), SE3());
  EXPECT_EQ(map.depth_quantile(a, 0.5), 0);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const PointId p = map.add_point({0, 0, 5.0 - i});
    map.add_observation(p, a, i);
    map.add_observation(p, b, i);
  }
  EXPECT_EQ(map.depth_quantile(a, 0), 1);
  EXPECT_EQ(map.depth_quantile(a, 0.5), 3);
  EXPECT_EQ(map.depth_quantile(a, 1), 5);
  EXPECT_EQ(map.tracked_points(a), 5);
}

// A frame has corners only: it cannot find more of a keyframe's points than these.
TEST(Map, TracksThePointsThatCornersSeeAndNotWhatTheyMissed) {
  Map map(testing::point_view());
  const auto frame = plain_frame(5);
  frame->added = 2;
  const KeyframeId id = map.add_keyframe(frame, SE3());
  for (const std::uint32_t i : {0U, 1U, 3U, 4U}) {
    map.add_observation(map.add_point({0, 0, 4}), id, i);
  }
  EXPECT_EQ(map.tracked_points(id), 2);
}

TEST(Map, RemembersItsFirstAndItsNewestKeyframe) {
  Map map(testing::point_view());
  EXPECT_FALSE(map.first().valid());
  const KeyframeId a = map.add_keyframe(plain_frame(1), SE3());
  const KeyframeId b = map.add_keyframe(plain_frame(1), SE3());
  EXPECT_EQ(map.first(), a);
  EXPECT_EQ(map.newest(), b);
  EXPECT_LT(map.keyframes()[a].sequence, map.keyframes()[b].sequence);
}

}  // namespace
}  // namespace cairn
