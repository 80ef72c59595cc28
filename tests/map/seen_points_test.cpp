#include "cairn/map/seen_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;

class SeenPoints : public ::testing::Test {
 protected:
  // What observations say, point by point.
  template <class Wanted>
  std::vector<PointId> points_where(Wanted&& wanted) const {
    std::vector<PointId> ids;
    map.points().for_each([&](PointId id, const MapPoint& point) {
      if (std::ranges::any_of(point.observations, wanted)) ids.push_back(id);
    });
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  testing::PointWorld world{17};
  Map map =
      testing::true_map(world, std::vector<SE3>{along(0), along(1.2), along(2.4), along(3.6)});
  const std::vector<KeyframeId> keyframes = testing::keyframes_of(map);
};

TEST_F(SeenPoints, AreAllThatOneOfTheKeyframesSeesEachOnce) {
  const auto seen = points_seen_from(map, std::span(keyframes).first(2));
  EXPECT_EQ(seen, points_where([&](const Observation& o) {
              return o.keyframe == keyframes[0] || o.keyframe == keyframes[1];
            }));
  EXPECT_LT(seen.size(), map.points().size());
  EXPECT_TRUE(points_seen_from(map, {}).empty());
}

TEST_F(SeenPoints, AreWithoutWhatWasAddedWhereOnlyCornersCount) {
  Keyframe& newest = map.keyframes()[map.newest()];
  const PointId point = *std::ranges::find_if(newest.points, [](PointId p) { return p.valid(); });
  map.erase_observation(point, map.newest());
  ASSERT_TRUE(map.points().contains(point));
  auto frame = std::make_shared<Frame>(*newest.frame);
  frame->add({}, {}, 0, Eigen::Vector2d::Zero());
  newest.points.emplace_back();
  map.add_observation(point, map.newest(), static_cast<std::uint32_t>(frame->size() - 1));
  newest.frame = frame;
  const std::vector<KeyframeId> one = {map.newest()};
  const auto seen = points_seen_from(map, one);
  const auto by_corners = points_seen_from(map, one, SeenBy::kCorners);
  EXPECT_EQ(seen.size(), by_corners.size() + 1);
  EXPECT_TRUE(std::ranges::binary_search(seen, point));
  EXPECT_FALSE(std::ranges::binary_search(by_corners, point));
}

}  // namespace
}  // namespace cairn
