#include "cairn/tracking/tracker.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::point_view;
using testing::PointWorld;

constexpr double kFrame = 1 / 30.0;  // seconds
constexpr double kStep = 0.02;       // along the walk, a frame

// Keyframes along the walk.
std::vector<SE3> some_poses() {
  std::vector<SE3> poses(6);
  for (int i = 0; i < 6; ++i) poses[i] = along(0.3 * i);
  return poses;
}

class TrackerTest : public ::testing::Test {
 protected:
  TrackerTest() {
    map = testing::true_map(world, some_poses());
    view = make_view(map, testing::keyframes_of(map)[0], 100000, 1);
    at(0);
    tracker.start_from(frame, along(0), view, testing::true_points(world, map, *frame));
  }

  // The frame at a place of the walk.
  std::shared_ptr<Frame> at(double s) { return show(world, along(s)); }
  std::shared_ptr<Frame> show(PointWorld& shown, const SE3& T_wc) {
    return frame = shown.show(T_wc, time += kFrame);
  }
  const TrackedFrame* track(std::shared_ptr<Frame> next) {
    record = {};
    return tracker.track(std::move(next), view, record);
  }
  static double distance(const SE3& a, const SE3& b) {
    return (a.translation() - b.translation()).norm();
  }

  PointWorld world{41}, elsewhere{42};
  Map map{point_view()};
  std::shared_ptr<const MapView> view;
  Tracker tracker{point_view(), {}};
  std::shared_ptr<Frame> frame;
  FrameRecord record;
  double time = 0;
};

TEST_F(TrackerTest, FollowsTheCameraThroughTheMap) {
  for (int i = 1; i <= 60; ++i) {
    const TrackedFrame* tracked = track(at(kStep * i));
    ASSERT_NE(tracked, nullptr) << i;
    const SE3 truth = along(kStep * i);
    EXPECT_LT(distance(tracked->T_wc, truth), 0.03) << i;
    EXPECT_LT(testing::rotation_error_deg(tracked->T_wc, truth), 0.4) << i;
    EXPECT_EQ(record.inliers, tracked->inliers);
    EXPECT_GE(record.matches, record.inliers);
    const SE3 carried = view->pose_of(tracked->reference).value() * tracked->T_rc;
    EXPECT_LT(distance(carried, tracked->T_wc), 1e-9);
  }
}

// Turns to and fro several times a second, as a hand does.
SE3 shaken(double s) {
  return along(s) * SE3(so3_exp({0.03 * std::sin(20 * s), 0.05 * std::sin(15 * s), 0}), {0, 0, 0});
}

// Mean error in degrees of a camera whose shutter rolls, where the map says that it does so.
double error_of_a_rolling_camera(double assumed) {
  PointWorld world(43, {.noise = 0.3, .readout = 0.03});
  const Map map = testing::true_map(world, some_poses());
  auto view = std::make_shared<MapView>(*make_view(map, testing::keyframes_of(map)[0], 100000, 1));
  view->readout = assumed;
  Tracker tracker(point_view(), {});
  const auto first = world.show(shaken(0), 0);
  tracker.start_from(first, shaken(0), view, testing::true_points(world, map, *first));
  double sum = 0;
  for (int i = 1; i <= 60; ++i) {
    const double s = kStep * i;
    const Vector6d velocity =
        (shaken(s - kStep / 10).inverse() * shaken(s + kStep / 10)).log() / (kFrame / 5);
    FrameRecord record;
    const TrackedFrame* tracked =
        tracker.track(world.show(shaken(s), kFrame * i, velocity), view, record);
    if (tracked == nullptr) return INFINITY;
    sum += testing::rotation_error_deg(tracked->T_wc, shaken(s)) / 60;
    EXPECT_EQ(tracked->frame->readout, assumed);
  }
  return sum;
}

TEST(Tracker, UndoesWhatARollingShutterDoesToAPicture) {
  EXPECT_LT(error_of_a_rolling_camera(0.03), 0.6 * error_of_a_rolling_camera(0));
}

TEST_F(TrackerTest, ClaimsNoMotionAcrossAGapInTime) {
  PointWorld rolling(41, {.readout = 0.03});  // the same points
  const auto next = [&](double s, double seconds) {
    return tracker.track(rolling.show(along(s), time += seconds), view, record);
  };
  ASSERT_NE(next(kStep, kFrame), nullptr);
  EXPECT_GT(tracker.last().frame->velocity.norm(), 0.1);
  ASSERT_NE(next(2 * kStep, 0.5), nullptr);
  EXPECT_EQ(tracker.last().frame->velocity.norm(), 0);
}

TEST_F(TrackerTest, GivesKeypointsTheRightPoints) {
  for (int i = 1; i <= 10; ++i) ASSERT_NE(track(at(kStep * i)), nullptr);
  const TrackedFrame& tracked = tracker.last();
  ASSERT_EQ(tracked.points.size(), frame->size());
  int right = 0, wrong = 0;
  for (std::size_t i = 0; i < frame->size(); ++i) {
    if (!tracked.points[i].valid()) continue;
    const int shown = world.point_of(map, map.points()[tracked.points[i]]);
    (shown == world.point_of(*frame, i) ? right : wrong)++;
  }
  EXPECT_EQ(right + wrong, tracked.inliers);
  EXPECT_GT(right, 100);
  EXPECT_LT(wrong, right / 50);
  EXPECT_GE(tracked.visible.size(), static_cast<std::size_t>(tracked.inliers));
}

TEST_F(TrackerTest, SurvivesASuddenStopAndATurnBack) {
  double s = 0;
  for (int i = 0; i < 15; ++i) ASSERT_NE(track(at(s += 2 * kStep)), nullptr);
  for (int i = 0; i < 5; ++i) {
    const TrackedFrame* tracked = track(at(s));
    ASSERT_NE(tracked, nullptr) << "standing, frame " << i;
    EXPECT_LT(distance(tracked->T_wc, along(s)), 0.03);
  }
  for (int i = 0; i < 15; ++i) {
    const TrackedFrame* tracked = track(at(s -= 2 * kStep));
    ASSERT_NE(tracked, nullptr) << "on the way back, frame " << i;
    EXPECT_LT(distance(tracked->T_wc, along(s)), 0.03);
  }
}

// What a camera sees through a hole in front of it.
std::shared_ptr<Frame> through_a_hole(const Frame& whole, double half_width) {
  auto frame = std::make_shared<Frame>();
  frame->timestamp = whole.timestamp;
  const Eigen::Vector2d middle(320, 240);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if ((whole.pixel(i) - middle).lpNorm<Eigen::Infinity>() > half_width) continue;
    frame->features.keypoints.push_back(whole.features.keypoints[i]);
    frame->features.descriptors.push_back(whole.features.descriptors[i]);
  }
  frame->grid.build(frame->features.keypoints);
  return frame;
}

// RMS distance from the truth of a camera that looks through a hole for a second.
double error_behind_a_hole(std::uint64_t seed) {
  PointWorld world(seed);
  const Map map = testing::true_map(world, some_poses());
  const auto view = make_view(map, testing::keyframes_of(map)[0], 100000, 1);
  Tracker tracker(point_view(), {});
  const auto first = world.show(along(0), 0);
  tracker.start_from(first, along(0), view, testing::true_points(world, map, *first));
  double sum = 0;
  for (int i = 1; i <= 40; ++i) {
    std::shared_ptr<Frame> frame = world.show(along(kStep * i), kFrame * i);
    if (i > 10) frame = through_a_hole(*frame, 65);
    FrameRecord record;
    const TrackedFrame* tracked = tracker.track(frame, view, record);
    if (tracked == nullptr) return INFINITY;
    const Eigen::Vector3d off = tracked->T_wc.translation() - along(kStep * i).translation();
    if (i > 10) sum += off.squaredNorm() / 30;
  }
  return std::sqrt(sum);
}

TEST(Tracker, GoesOnAsItWentWherePointsInOneSpotCannotTellATurnFromAShift) {
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) mean += error_behind_a_hole(seed) / 20;
  EXPECT_LT(mean, 0.014);
}

TEST_F(TrackerTest, FallsBackOnTheReferenceKeyframeAfterAJump) {
  for (int i = 1; i <= 5; ++i) ASSERT_NE(track(at(kStep * i)), nullptr);
  const TrackedFrame* tracked = track(at(0.45));  // 17 frames' way in one
  ASSERT_NE(tracked, nullptr);
  EXPECT_LT(distance(tracked->T_wc, along(0.45)), 0.03);
}

TEST_F(TrackerTest, LosesTheCameraWhenItShowsAnotherWorld) {
  for (int i = 1; i <= 5; ++i) ASSERT_NE(track(at(kStep * i)), nullptr);
  EXPECT_EQ(track(show(elsewhere, along(kStep * 6))), nullptr);
  EXPECT_EQ(track(show(elsewhere, along(kStep * 7))), nullptr);
}

TEST_F(TrackerTest, LosesTheCameraInTheDark) {
  PointWorld dark(43, {.count = 0, .clutter = 0});
  EXPECT_EQ(track(show(dark, along(0))), nullptr);
  PointWorld nonsense(44, {.count = 0, .clutter = 900});
  EXPECT_EQ(track(show(nonsense, along(0))), nullptr);
}

TEST_F(TrackerTest, GoesOnFromWhereItIsToldTo) {
  ASSERT_EQ(track(show(elsewhere, along(0))), nullptr);
  const double s = 1.1;
  view = make_view(map, testing::keyframes_of(map)[4], 100000, 2);
  const auto found = at(s);
  tracker.start_from(found, along(s), view, testing::true_points(world, map, *found));
  for (int i = 1; i <= 5; ++i) {
    const TrackedFrame* tracked = track(at(s + kStep * i));
    ASSERT_NE(tracked, nullptr) << i;
    EXPECT_LT(distance(tracked->T_wc, along(s + kStep * i)), 0.03);
  }
}

// The mapper may move everything between two frames: the tracker goes along.
TEST_F(TrackerTest, MovesWithAMapThatIsMoved) {
  for (int i = 1; i <= 10; ++i) ASSERT_NE(track(at(kStep * i)), nullptr);
  const SE3 shift(so3_exp({0.1, 0.3, -0.2}), Eigen::Vector3d(2, -1, 3));
  map.keyframes().for_each([&](KeyframeId, Keyframe& k) { k.T_wc = shift * k.T_wc; });
  map.points().for_each([&](PointId id, MapPoint& p) {
    p.position = shift * p.position;
    map.update_geometry(id);
  });
  view = make_view(map, testing::keyframes_of(map)[1], 100000, 2);
  for (int i = 11; i <= 20; ++i) {
    const TrackedFrame* tracked = track(at(kStep * i));
    ASSERT_NE(tracked, nullptr) << i;
    EXPECT_LT(distance(tracked->T_wc, shift * along(kStep * i)), 0.03);
  }
}

TEST_F(TrackerTest, KeepsItsPointsWhenTheMapLosesSome) {
  for (int i = 1; i <= 5; ++i) ASSERT_NE(track(at(kStep * i)), nullptr);
  map.points().for_each([&](PointId id, const MapPoint&) {
    if (id.slot % 2 == 0) map.erase_point(id);
  });
  view = make_view(map, testing::keyframes_of(map)[0], 100000, 2);
  const TrackedFrame* tracked = track(at(kStep * 6));
  ASSERT_NE(tracked, nullptr);
  for (const PointId p : tracked->points) {
    EXPECT_TRUE(!p.valid() || map.points().contains(p));
  }
}

TEST_F(TrackerTest, WantsNoKeyframeWhileTheCameraStandsStillHoweverLong) {
  const Frame picture = *frame;
  for (int i = 1; i <= 90; ++i) {
    auto again = std::make_shared<Frame>(picture);
    again->timestamp = picture.timestamp + i * kFrame;
    ASSERT_NE(track(again), nullptr) << i;
    EXPECT_FALSE(tracker.wants_keyframe(0)) << i;
  }
}

TEST_F(TrackerTest, WantsAKeyframeOfEachPictureFromElsewhereThatTheMapperHasTimeFor) {
  ASSERT_NE(track(at(kStep)), nullptr);
  EXPECT_TRUE(tracker.wants_keyframe(0));
  EXPECT_FALSE(tracker.wants_keyframe(1)) << "it is not urgent, and the mapper has work";
}

TEST_F(TrackerTest, WantsAKeyframeOfAMapperThatIsBusyButNotBehindWhenHardlyAnythingIsLeft) {
  auto wealthy = std::make_shared<MapView>(*view);
  wealthy->reference_tracked *= 5;
  view = wealthy;
  ASSERT_NE(track(at(kStep)), nullptr);
  EXPECT_TRUE(tracker.wants_keyframe(0));
  EXPECT_TRUE(tracker.wants_keyframe(1));
  EXPECT_FALSE(tracker.wants_keyframe(3));
}

}  // namespace
}  // namespace cairn
