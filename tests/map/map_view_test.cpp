#include "cairn/map/map_view.h"

#include <gtest/gtest.h>

#include <set>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::PointWorld;

class MapViewTest : public ::testing::Test {
 protected:
  PointWorld world{21};
  // Three keyframes here, and one far away that shares nothing with them.
  Map map = testing::true_map(
      world, std::vector<SE3>{along(0), along(0.3), along(0.6),
                              SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(60, 0, 0))});
  const std::vector<KeyframeId> keyframes = testing::keyframes_of(map);
};

TEST_F(MapViewTest, HoldsThePointsAroundItsReference) {
  const auto view = make_view(map, keyframes[1], 100000, 7);
  EXPECT_EQ(view->version, 7u);
  EXPECT_EQ(view->reference, keyframes[1]);
  EXPECT_EQ(view->reference_frame, map.keyframes()[keyframes[1]].frame);
  EXPECT_EQ(view->map_keyframes, map.keyframes().size());
  EXPECT_EQ(view->map_points, map.points().size());
  EXPECT_NEAR(view->median_depth, map.depth_quantile(keyframes[1], 0.5), 1e-12);
  std::set<PointId> expected;
  for (int k : {0, 1, 2}) {
    for (const PointId p : map.keyframes()[keyframes[k]].points) {
      if (p.valid()) expected.insert(p);
    }
  }
  std::set<PointId> found;
  for (const MapView::Point& p : view->points) {
    found.insert(p.id);
    EXPECT_EQ(p.position, map.points()[p.id].position);
    EXPECT_EQ(p.descriptor, map.points()[p.id].descriptor);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found.size(), view->points.size()) << "a point is there once";
}

TEST_F(MapViewTest, FindsPointsAndPosesById) {
  const auto view = make_view(map, keyframes[0], 100000, 1);
  for (std::uint32_t i = 0; i < view->points.size(); ++i) {
    ASSERT_EQ(view->index_of(view->points[i].id), i);
  }
  EXPECT_EQ(view->index_of(PointId{1000000, 0}), MapView::kNone);
  const PointId first = view->points.front().id;
  EXPECT_EQ(view->index_of(PointId{first.slot, first.generation + 1U}), MapView::kNone);
  for (int k : {0, 1, 2}) {
    const auto T_wc = view->pose_of(keyframes[k]);
    ASSERT_TRUE(T_wc.has_value());
    EXPECT_EQ(T_wc->translation(), map.keyframes()[keyframes[k]].T_wc.translation());
  }
  EXPECT_FALSE(view->pose_of(keyframes[3]).has_value()) << "shares nothing with the reference";
}

TEST_F(MapViewTest, SaysWhichPointEachKeypointOfTheReferenceShows) {
  const auto view = make_view(map, keyframes[2], 100000, 1);
  const auto& points = map.keyframes()[keyframes[2]].points;
  ASSERT_EQ(view->reference_points.size(), points.size());
  int seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].valid()) {
      EXPECT_EQ(view->reference_points[i], MapView::kNone);
      continue;
    }
    ASSERT_LT(view->reference_points[i], view->points.size());
    EXPECT_EQ(view->points[view->reference_points[i]].id, points[i]);
    ++seen;
  }
  EXPECT_EQ(view->reference_tracked, seen);
}

// So that frames are compared with all that they can find.
TEST_F(MapViewTest, CountsPointsThatOnlyTheReferenceHasSeen) {
  const int before = make_view(map, keyframes[1], 100000, 1)->reference_tracked;
  const auto& points = map.keyframes()[keyframes[1]].points;
  const auto free = std::find(points.begin(), points.end(), PointId());
  ASSERT_NE(free, points.end());
  const PointId assumed = map.add_point({0, 0, 4});
  map.add_observation(assumed, keyframes[1], std::uint32_t(free - points.begin()));
  EXPECT_EQ(make_view(map, keyframes[1], 100000, 2)->reference_tracked, before + 1);
}

TEST_F(MapViewTest, StopsAtTheMostPointsButKeepsThoseOfTheReference) {
  const int own = map.tracked_points(keyframes[1]);
  const auto view = make_view(map, keyframes[1], 10, 1);
  EXPECT_EQ(static_cast<int>(view->points.size()), own);
  for (const KeyframeId k : {keyframes[0], keyframes[1], keyframes[2]}) {
    EXPECT_TRUE(view->pose_of(k).has_value()) << "poses are cheap and always there";
  }
}

TEST_F(MapViewTest, StaysAsItWasWhenTheMapChanges) {
  const auto view = make_view(map, keyframes[1], 100000, 1);
  const PointId id = view->points.front().id;
  const Eigen::Vector3d before = view->points.front().position;
  map.points()[id].position += Eigen::Vector3d::Ones();
  map.erase_keyframe(keyframes[2]);
  EXPECT_EQ(view->points.front().position, before);
  EXPECT_TRUE(view->pose_of(keyframes[2]).has_value());
}

}  // namespace
}  // namespace cairn
