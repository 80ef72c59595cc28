#include "cairn/mapping/keyframe_motion.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::keyframes_of;
using testing::PointWorld;
using testing::true_map;

const std::vector<SE3> kWalk = {along(0), along(0.4), along(0.8)};

// Of the keypoints to where the map says that they are, root mean square, pixels.
double off(const Map& map) {
  double sum = 0;
  int count = 0;
  map.points().for_each([&](PointId, const MapPoint& point) {
    for (const Observation& o : point.observations) {
      const Keyframe& k = map.keyframes()[o.keyframe];
      const Eigen::Vector2d at = map.view().pinhole().project(k.T_wc.inverse() * point.position);
      sum += (at - k.frame->pixel(o.keypoint)).squaredNorm();
      ++count;
    }
  });
  return std::sqrt(sum / count);
}

TEST(KeyframeMotion, IsFoundWhereAKeyframeMovedOtherwiseThanFromFrameToFrame) {
  const Vector6d velocity = (Vector6d() << 0.4, 0.2, 0.1, 0.3, -0.5, 0.4).finished();
  const std::vector<Vector6d> tremor(3, velocity + Vector6d::Constant(0.08));
  PointWorld world(601, {.noise = 0.05, .clutter = 0, .readout = 0.025});
  Map map = true_map(world, kWalk, tremor);
  map.keyframes().for_each([&](KeyframeId, Keyframe& k) {
    auto frame = std::make_shared<Frame>(*k.frame);
    frame->velocity = velocity;
    k.frame = std::move(frame);
  });
  map.set_readout(0.025);
  const double before = off(map);
  const std::shared_ptr<const Frame> held = map.keyframes()[keyframes_of(map).back()].frame;
  const std::vector<Keypoint> as_it_was = held->features.keypoints;
  find_motions(map);
  EXPECT_LT(off(map), 0.5 * before);
  map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
    EXPECT_LT((k.frame->velocity - tremor[0]).tail<3>().norm(),
              0.5 * (velocity - tremor[0]).tail<3>().norm());
  });
  EXPECT_EQ(held->features.keypoints, as_it_was) << "a tracker may look at it";
}

TEST(KeyframeMotion, IsFoundWhereNothingIsKnownOfIt) {
  const std::vector<Vector6d> moving(3, (Vector6d() << 0.2, 0.1, 0.1, 0.3, -0.4, 0.3).finished());
  PointWorld world(603, {.noise = 0.05, .clutter = 0, .readout = 0.025});
  Map map = true_map(world, kWalk, moving);
  map.keyframes().for_each([&](KeyframeId, Keyframe& k) {
    auto frame = std::make_shared<Frame>(*k.frame);
    frame->velocity.setZero();
    k.frame = std::move(frame);
  });
  map.set_readout(0.025);
  const double before = off(map);
  find_motions(map);
  EXPECT_LT(off(map), 0.1 * before);
}

TEST(KeyframeMotion, OnceKnownSaysWhereAnInstantShutterWouldHaveSeenKeypoints) {
  const std::vector<Vector6d> moving(3, (Vector6d() << 0.2, 0.1, 0.1, 0.3, -0.4, 0.3).finished());
  PointWorld world(604, {.noise = 0.05, .clutter = 0, .readout = 0.025});
  Map map = true_map(world, kWalk, moving);
  const KeyframeId one = keyframes_of(map)[1];
  const double right = off(map);
  map.set_readout(0.025);
  set_motions(map, std::vector<KeyframeMotion>{{one, -moving[1]}});
  const double wrong = off(map);
  EXPECT_EQ(map.keyframes()[one].frame->velocity, -moving[1]);
  set_motions(map, std::vector<KeyframeMotion>{{one, moving[1]}});
  EXPECT_LT(off(map), std::min(0.5 * wrong, right));
}

TEST(KeyframeMotion, OfAnInstantShutterNothingIsLookedFor) {
  PointWorld world(602, {.clutter = 0});
  Map map = true_map(world, kWalk);
  const auto frame = map.keyframes()[keyframes_of(map).front()].frame;
  find_motions(map);
  set_motions(map, std::vector<KeyframeMotion>{{keyframes_of(map).front(), Vector6d::Ones()}});
  EXPECT_EQ(map.keyframes()[keyframes_of(map).front()].frame, frame);
}

}  // namespace
}  // namespace cairn
