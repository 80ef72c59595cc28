#include "cairn/system/frame_log.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;

double distance(const SE3& a, const SE3& b) { return (a.inverse() * b).log().norm(); }

class FrameLogTest : public ::testing::Test {
 protected:
  KeyframeId add_keyframe(const SE3& T_wc, double timestamp) {
    return map.add_keyframe(world.show(T_wc, timestamp), T_wc);
  }

  testing::PointWorld world{101};
  Map map{testing::point_view()};
  KeyframeId first = add_keyframe(along(0), 0), second = add_keyframe(along(0.5), 1);
  FrameLog log;
};

TEST_F(FrameLogTest, CarriesAFrameByItsKeyframe) {
  const SE3 T_rc = along(0.5).inverse() * along(0.7);
  log.add(1.5, second, T_rc, along(0.7));
  const SE3 correction(so3_exp({0.1, 0.2, 0.3}), Eigen::Vector3d(1, 2, 3));
  map.keyframes()[second].T_wc = correction * along(0.5);
  const Trajectory trajectory = log.final_trajectory(map, {});
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory[0].timestamp, 1.5);
  EXPECT_LT(distance(trajectory[0].T_wc, correction * along(0.7)), 1e-9);
  ASSERT_EQ(log.live_trajectory().size(), 1u);
  EXPECT_LT(distance(log.live_trajectory()[0].T_wc, along(0.7)), 1e-12) << "as it was known then";
}

TEST_F(FrameLogTest, CarriesAFrameByTheParentsOfABuriedKeyframe) {
  const KeyframeId third = add_keyframe(along(1), 2), fourth = add_keyframe(along(1.2), 3);
  log.add(3.5, fourth, along(1.2).inverse() * along(1.3), along(1.3));
  // The fourth is buried in the third, then the third in the second.
  const std::vector<BuriedKeyframe> buried = {{fourth, third, along(1).inverse() * along(1.2)},
                                              {third, second, along(0.5).inverse() * along(1)}};
  map.erase_keyframe(fourth);
  map.erase_keyframe(third);
  add_keyframe(along(9), 4);  // takes a slot of theirs
  const SE3 correction(so3_exp({0, 0.2, 0}), Eigen::Vector3d(-1, 0, 0.5));
  map.keyframes()[second].T_wc = correction * along(0.5);
  const Trajectory trajectory = log.final_trajectory(map, buried);
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_LT(distance(trajectory[0].T_wc, correction * along(1.3)), 1e-9);
}

TEST_F(FrameLogTest, AFrameThatIsAKeyframeIsWhereTheKeyframeIs) {
  log.add(1, first, along(0).inverse() * along(0.5), along(0.5));
  map.keyframes()[second].T_wc = along(0.6);
  const Trajectory trajectory = log.final_trajectory(map, {});
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_LT(distance(trajectory[0].T_wc, along(0.6)), 1e-9);
}

TEST_F(FrameLogTest, AFrameIsWhereItSeesWhatItSaw) {
  Map seen = testing::true_map(world, std::vector<SE3>{along(0), along(0.4), along(0.8)});
  const auto frame = world.show(along(0.6), 9);
  const auto sightings = sightings_of(*frame, testing::true_points(world, seen, *frame));
  const SE3 T_rc = along(0.63);  // from the first keyframe, as it was thought to be
  log.add(9, seen.first(), T_rc, T_rc, sightings, 2);
  log.add(9.03, seen.first(), T_rc, T_rc, std::span(sightings).first(10), 2);
  const Trajectory trajectory = log.final_trajectory(seen, {});
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_LT((trajectory[0].T_wc.translation() - along(0.6).translation()).norm(), 0.004);
  EXPECT_LT(distance(trajectory[1].T_wc, trajectory[0].T_wc), 1e-9)
      << "what saw too little drifts as the frame before it did";
}

TEST_F(FrameLogTest, AFrameThatWasAKeyframeIsWhereItSawWhatItSawAtLast) {
  Map seen = testing::true_map(
      world, std::vector<SE3>{along(0), along(0.4), along(0.6), along(0.8), along(1.2)});
  const KeyframeId id = testing::keyframes_of(seen)[2];
  ASSERT_LT(distance(seen.keyframes()[id].T_wc, along(0.6)), 1e-9);
  const double timestamp = seen.keyframes()[id].timestamp();
  const std::vector<BuriedKeyframe> buried = {bury_keyframe(seen, id)};
  EXPECT_FALSE(seen.keyframes().contains(id));
  EXPECT_GE(buried[0].sightings.size(), 30u);
  const SE3 T_rc = along(0.63);
  log.add(timestamp, seen.first(), T_rc, T_rc);  // tracking saw nothing of what is now in the map
  const Trajectory trajectory = log.final_trajectory(seen, buried);
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_LT((trajectory[0].T_wc.translation() - along(0.6).translation()).norm(), 0.004);
}

TEST_F(FrameLogTest, AKeyframeMovesAsTheFramesAroundItSay) {
  const auto trembling = [](double t) {
    const double sway = std::sin(2 * M_PI * 4.5 * (t - 0.98));
    return SE3(so3_exp(Eigen::Vector3d(0, 0.02 * sway, 0.3 * (t - 1))),
               Eigen::Vector3d(0.2 * t, 0.01 * sway, 0));
  };
  map.keyframes()[second].T_wc = trembling(1);
  for (const double frame : {-9, -2, -1, 0, 1, 2}) {
    const double t = 1 + frame / 30;
    const KeyframeId carrier = frame < 0 ? first : second;
    log.add(t, carrier, map.keyframes()[carrier].T_wc.inverse() * trembling(t), trembling(t));
  }
  const std::vector<KeyframeMotion> motions = log.keyframe_motions(map, {});
  ASSERT_EQ(motions.size(), 1u) << "of the first keyframe there is no frame";
  EXPECT_EQ(motions[0].keyframe, second);
  const auto mean = [&](double dt) -> Vector6d {
    return (trembling(1 - dt).inverse() * trembling(1 + dt)).log() / (2 * dt);
  };
  const Vector6d truth = mean(1e-5);
  EXPECT_LT((motions[0].velocity - truth).norm(), 0.04 * truth.norm());
  EXPECT_LT((motions[0].velocity - truth).norm(), 0.3 * (mean(1 / 30.0) - truth).norm());
}

TEST_F(FrameLogTest, AKeyframeWithoutFramesNearItSaysNothingOfItsMotion) {
  log.add(1, first, along(0).inverse() * along(0.5), along(0.5));
  log.add(2, second, along(0.5).inverse() * along(0.7), along(0.7));
  const std::vector<KeyframeMotion> motions = log.keyframe_motions(map, {});
  ASSERT_EQ(motions.size(), 1u);
  EXPECT_TRUE(motions[0].velocity.isZero(0));
}

TEST_F(FrameLogTest, KeyframesComeInOrderOfTime) {
  map.erase_keyframe(first);
  add_keyframe(along(1), 2);
  add_keyframe(along(2), 3);
  const Trajectory trajectory = keyframe_trajectory(map);
  ASSERT_EQ(trajectory.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(trajectory[i].timestamp, double(i + 1));
}

}  // namespace
}  // namespace cairn
