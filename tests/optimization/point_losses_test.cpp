#include "cairn/optimization/point_losses.h"

#include <gtest/gtest.h>

#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::few_poses;
using testing::map_of;
using testing::points_of;
using testing::Random;

constexpr std::size_t kOnWall = 60, kOnBook = 60, kOthers = 120;

// Of a wall, a thing before it, and of neither; where six keyframes see them, up to so many pixels
// of noise each.
Map map_with(double wall_noise, double book_noise, double other_noise) {
  Random random(31);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < kOnWall + kOnBook + kOthers; ++i) {
    points.emplace_back(random.uniform(-1, 1), random.uniform(-0.7, 0.7), i < kOnWall ? 4 : 3);
  }
  Map map = map_of(points, few_poses(6));
  const auto ids = points_of(map);
  const PlaneId wall =
      map.add_plane(map.first(), testing::seen_from(few_poses(1)[0], testing::wall_corners()));
  map.planes()[wall].confirmed = true;
  for (std::size_t i = 0; i < kOnWall; ++i) map.set_plane_of(ids[i], wall);
  ObjectLandmark book;
  book.reference = map.first();
  book.born = true;
  book.points.assign(ids.begin() + kOnWall, ids.begin() + kOnWall + kOnBook);
  map.objects().insert(book);
  map.keyframes().for_each([&](KeyframeId, Keyframe& keyframe) {
    auto frame = std::make_shared<Frame>(*keyframe.frame);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double noise = i < kOnWall             ? wall_noise
                           : i < kOnWall + kOnBook ? book_noise
                                                   : other_noise;
      frame->move(i, noise * Eigen::Vector2d(random.gaussian(), random.gaussian()));
    }
    keyframe.frame = frame;
  });
  for (const PointId id : ids) {
    for (Observation& o : map.points()[id].observations) o.patch = PatchState::kFound;
  }
  return map;
}

// Of an error within the core.
double weight(ceres::LossFunction* loss) {
  double rho[3];
  loss->Evaluate(0, rho);
  return rho[1];
}

TEST(PointLosses, WeighAPlanesSightingsByHowMuchMoreExactTheyAre) {
  const Map map = map_with(0.2, 0.4, 0.4);
  PointLosses losses(0.5);
  losses.weigh_landmarks(map);
  const auto ids = points_of(map);
  EXPECT_NEAR(weight(losses.of(ids.front(), true)), 4, 0.8);
  EXPECT_EQ(weight(losses.of(ids.back(), true)), 1);
}

TEST(PointLosses, WeighAThingsSightingsLessWhereTheyAreLessExact) {
  const Map map = map_with(0.4, 0.6, 0.4);
  PointLosses losses(0.5);
  losses.weigh_landmarks(map);
  const auto ids = points_of(map);
  EXPECT_NEAR(weight(losses.of(ids[kOnWall], true)), 1 / 2.25, 0.1);
  EXPECT_NEAR(weight(losses.of(ids.front(), true)), 1, 0.2);
}

TEST(PointLosses, BelieveNoneMoreThanNineTimesAsMuch) {
  const Map map = map_with(0.01, 0.4, 0.4);
  PointLosses losses(0.5);
  losses.weigh_landmarks(map);
  EXPECT_NEAR(weight(losses.of(points_of(map).front(), true)), 9, 1e-9);
}

TEST(PointLosses, SayNothingOfCornersAndOfWhatFewSightingsShow) {
  Map map = map_with(0.1, 0.4, 0.4);
  const auto ids = points_of(map);
  PointLosses losses(0.5);
  EXPECT_EQ(weight(losses.of(ids.front(), true)), 1);  // nothing has been weighed yet
  losses.weigh_landmarks(map);
  EXPECT_EQ(weight(losses.of(ids.front(), false)), 1);
  for (std::size_t i = 30; i < kOnWall; ++i) map.set_plane_of(ids[i], {});
  losses.weigh_landmarks(map);
  EXPECT_EQ(weight(losses.of(ids.front(), true)), 1);
}

TEST(PointLosses, SayNothingOfAPointThatHasTakenTheSlotOfOneOfAThing) {
  Map map = map_with(0.4, 0.2, 0.4);
  const PointId gone = points_of(map)[kOnWall];
  map.erase_point(gone);
  const PointId other = map.add_point({0, 0, 3});
  ASSERT_EQ(other.slot, gone.slot);
  PointLosses losses(0.5);
  losses.weigh_landmarks(map);
  EXPECT_NEAR(weight(losses.of(points_of(map)[kOnWall + 1], true)), 4, 0.8);
  EXPECT_EQ(weight(losses.of(other, true)), 1);
}

}  // namespace
}  // namespace cairn
