#include "cairn/mapping/sighting.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::PointWorld;
using testing::rotation_error_deg;
using testing::true_map;
using testing::true_points;

const std::vector<SE3> kWalk = {along(0), along(0.4), along(0.8)};
const SE3 kOff(so3_exp({0.01, -0.02, 0.01}), Eigen::Vector3d(0.03, -0.05, 0.02));

double distance(const SE3& a, const SE3& b) { return (a.translation() - b.translation()).norm(); }

TEST(Sighting, AFrameFindsItsPlaceFromWhatItSaw) {
  PointWorld world(501);
  const Map map = true_map(world, kWalk);
  const auto frame = world.show(along(0.5), 9);
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  ASSERT_GT(sightings.size(), 200u);
  const auto T_wc = place(map, sightings, 2, along(0.5) * kOff, Vector6d::Zero());
  ASSERT_TRUE(T_wc);
  EXPECT_LT(distance(*T_wc, along(0.5)), 0.004);
  EXPECT_LT(rotation_error_deg(*T_wc, along(0.5)), 0.05);
}

TEST(Sighting, RowsAreTakenForTheMomentAtWhichTheyWereRead) {
  PointWorld world(502, {.readout = 0.025});
  Map map = true_map(world, kWalk);
  Vector6d velocity;
  velocity << 0.4, 0.2, 0.1, 0.3, -0.5, 0.4;
  const auto frame = world.show(along(0.5), 9, velocity);
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  const auto error = [&](double readout) {
    map.set_readout(readout);
    const auto T_wc = place(map, sightings, 2, along(0.5) * kOff, velocity);
    return T_wc ? distance(*T_wc, along(0.5)) + rotation_error_deg(*T_wc, along(0.5)) : 1e9;
  };
  EXPECT_LT(error(0.025), 0.05);
  EXPECT_GT(error(0), 2 * error(0.025));
}

TEST(Sighting, TheCameraMayHaveMovedOtherwiseWhileItsRowsWereRead) {
  PointWorld world(507, {.noise = 0.1, .readout = 0.025});
  Map map = true_map(world, kWalk);
  map.set_readout(0.025);
  const Vector6d velocity = (Vector6d() << 0.4, 0.2, 0.1, 0.3, -0.5, 0.4).finished();
  const auto frame = world.show(along(0.5), 9, velocity + Vector6d::Constant(0.1));
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  const auto T_wc = place(map, sightings, 2, along(0.5) * kOff, velocity);
  ASSERT_TRUE(T_wc);
  EXPECT_LT(rotation_error_deg(*T_wc, along(0.5)), 0.01);
}

TEST(Sighting, TheLensIsTakenForWhatTheMapFoundItToBe) {
  PointWorld world(503);
  Map map = true_map(world, kWalk);
  const auto frame = world.show(along(0.5), 9);
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  const auto place_now = [&] {
    return place(map, sightings, 2, along(0.5), Vector6d::Zero()).value();
  };
  const double right = distance(place_now(), along(0.5));
  map.set_lens({{0.05}});  // the focal length would be so much longer
  EXPECT_GT(distance(place_now(), along(0.5)), 0.02 + right);
}

TEST(Sighting, PointsThatTookTheNameOfOneThatIsGoneSayNothing) {
  PointWorld world(504);
  Map map = true_map(world, kWalk);
  const auto frame = world.show(along(0.5), 9);
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  map.points().for_each([](PointId, MapPoint& point) { point.born = 7; });
  EXPECT_FALSE(place(map, sightings, 6, along(0.5), Vector6d::Zero()));
  EXPECT_TRUE(place(map, sightings, 7, along(0.5), Vector6d::Zero()));
}

TEST(Sighting, PointsThatWentAstrayDoNotTakeTheFrameWithThem) {
  PointWorld world(506);
  Map map = true_map(world, kWalk);
  const auto frame = world.show(along(0.5), 9);
  const auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  const Pinhole& pinhole = map.view().pinhole();
  for (std::size_t i = 0; i < 40; ++i) {  // to where a step of the camera moves them most
    Eigen::Vector3d& position = map.points()[sightings[i].point].position;
    const Eigen::Vector2d pixel = pinhole.project(along(0.5).inverse() * position);
    position = along(0.5) * (0.02 * pinhole.unproject(pixel + Eigen::Vector2d(100, 50)));
  }
  const auto T_wc = place(map, sightings, 2, along(0.5), Vector6d::Zero());
  ASSERT_TRUE(T_wc);
  EXPECT_LT(distance(*T_wc, along(0.5)), 0.002);
}

TEST(Sighting, TooFewOfThemPlaceNothing) {
  PointWorld world(505);
  const Map map = true_map(world, kWalk);
  const auto frame = world.show(along(0.5), 9);
  auto sightings = sightings_of(*frame, true_points(world, map, *frame));
  sightings.resize(20);
  EXPECT_FALSE(place(map, sightings, 2, along(0.5), Vector6d::Zero()));
  EXPECT_FALSE(place(map, {}, 2, along(0.5), Vector6d::Zero()));
}

}  // namespace
}  // namespace cairn
