#include "cairn/optimization/map_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cairn/optimization/odometry_blocks.h"
#include "map/links.h"
#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::broken_links;
using testing::errors_of;
using testing::keyframes_of;
using testing::PointWorld;
using testing::Random;

std::vector<SE3> walk(int count, double step) {
  std::vector<SE3> poses;
  poses.reserve(count);
  for (int i = 0; i < count; ++i) poses.push_back(along(i * step));
  return poses;
}

// Moves all points, and all keyframes but the first.
void disturb(Map& map, std::uint64_t seed, double angle, double distance, double point_sigma) {
  Random random(seed);
  map.keyframes().for_each([&](KeyframeId id, Keyframe& k) {
    if (id != map.first()) k.T_wc = k.T_wc * random.motion(angle, distance);
  });
  map.points().for_each(
      [&](PointId, MapPoint& p) { p.position += point_sigma * random.gaussian3(); });
}

int observations_of(const Map& map) {
  int count = 0;
  map.points().for_each(
      [&](PointId, const MapPoint& p) { count += static_cast<int>(p.observations.size()); });
  return count;
}

// Everything that an adjustment may change, to be compared bit by bit.
std::vector<double> numbers_of(const Map& map) {
  std::vector<double> numbers;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
    for (int i = 0; i < 4; ++i) numbers.push_back(k.T_wc.rotation().coeffs()[i]);
    for (int i = 0; i < 3; ++i) numbers.push_back(k.T_wc.translation()[i]);
  });
  map.points().for_each([&](PointId id, const MapPoint& p) {
    numbers.push_back(id.slot);
    for (int i = 0; i < 3; ++i) numbers.push_back(p.position[i]);
  });
  return numbers;
}

TEST(FullAdjustment, BringsADisturbedMapBackToTheTruth) {
  PointWorld world(31, {.noise = 0.2});
  Map map = testing::true_map(world, walk(6, 0.3));
  const SE3 first = map.keyframes()[map.first()].T_wc;
  disturb(map, 1, 0.02, 0.05, 0.05);
  const int before = observations_of(map);
  const double disturbed = errors_of(map, world).median;
  const AdjustmentSummary summary = adjust_fully(map, {}, nullptr);
  EXPECT_TRUE(summary.usable) << summary.to_string();
  EXPECT_LT(summary.final_rms, summary.initial_rms);
  const auto errors = errors_of(map, world);
  EXPECT_LT(errors.median, 0.4 * disturbed);
  EXPECT_LT(errors.camera, 0.02);
  EXPECT_LT(errors.rotation_deg, 0.2);
  EXPECT_EQ((map.keyframes()[map.first()].T_wc.matrix() - first.matrix()).norm(), 0);
  EXPECT_GT(observations_of(map), 0.9 * before) << "good observations were thrown away";
  EXPECT_EQ(broken_links(map), "");
}

TEST(FullAdjustment, FindsTheSameWithManyThreadsButForRounding) {
  std::vector<double> found[2];
  for (const int threads : {1, 4}) {
    PointWorld world(31, {.noise = 0.2});
    Map map = testing::true_map(world, walk(6, 0.3));
    disturb(map, 1, 0.02, 0.05, 0.05);
    AdjustmentOptions options;
    options.full_threads = threads;
    ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
    found[threads > 1] = numbers_of(map);
  }
  ASSERT_EQ(found[0].size(), found[1].size());
  for (std::size_t i = 0; i < found[0].size(); ++i) EXPECT_NEAR(found[0][i], found[1][i], 1e-5);
}

// Frames hang on their keyframes by lengths in units of the map.
TEST(FullAdjustment, KeepsTheUnitOfTheMap) {
  PointWorld world(38);
  Map map = testing::true_map(world, walk(6, 0.3));
  disturb(map, 8, 0.01, 0.05, 0.05);
  auto spread = [&] {
    const Eigen::Vector3d origin = map.keyframes()[map.first()].T_wc.translation();
    double sum = 0;
    map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
      sum += (k.T_wc.translation() - origin).squaredNorm();
    });
    return std::sqrt(sum);
  };
  const double before = spread();
  ASSERT_TRUE(adjust_fully(map, {}, nullptr).usable);
  EXPECT_NEAR(spread() / before, 1, 1e-9);
}

// Ten keyframes of a camera in a shaking hand.
struct RollingWalk {
  explicit RollingWalk(double readout) : world(39, {.noise = 0.5, .readout = readout}) {
    Random random(9);
    for (int i = 0; i < 10; ++i) {
      poses.push_back(along(i * 0.2));
      velocities.push_back(random.motion(0.6, 0.8).log());
    }
    map = testing::true_map(world, poses, velocities);
  }
  double worst_rotation_deg() const {
    double worst = 0;
    int i = 0;
    map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
      worst = std::max(worst, testing::rotation_error_deg(k.T_wc, poses[i++]));
    });
    return worst;
  }

  PointWorld world;
  std::vector<SE3> poses;
  std::vector<Vector6d> velocities;
  Map map{testing::point_view()};
};

// A walk of which the second half has drifted away, and shares no point with the first any more.
void tear(Map& map, const SE3& drift) {
  const std::vector<KeyframeId> ids = keyframes_of(map);
  const auto is_late = [&](KeyframeId id) {
    return std::find(ids.begin(), ids.end(), id) - ids.begin() >= std::ssize(ids) / 2;
  };
  std::vector<std::pair<PointId, KeyframeId>> links;
  map.points().for_each([&](PointId id, MapPoint& p) {
    const bool late = is_late(p.observations.front().keyframe);
    for (const Observation& o : p.observations) {
      if (is_late(o.keyframe) != late) links.emplace_back(id, o.keyframe);
    }
    if (late) p.position = drift * p.position;
  });
  for (const auto& [point, keyframe] : links) map.erase_observation(point, keyframe);
  for (const KeyframeId id : ids) {
    if (is_late(id)) map.keyframes()[id].T_wc = drift * map.keyframes()[id].T_wc;
  }
}

double error_of_a_torn_walk(bool path_is_known) {
  PointWorld world(38, {.noise = 0.2});
  Map map = testing::true_map(world, walk(8, 0.25));
  OdometryBlocks path(map);
  tear(map, SE3(so3_exp({0, 0.1, 0}), {0.5, 0, 0}));
  EXPECT_TRUE(adjust_fully(map, {}, nullptr, path_is_known ? &path : nullptr).usable);
  return errors_of(map, world).camera;
}

TEST(FullAdjustment, LeadsBackToThePathThatItIsGiven) {
  EXPECT_GT(error_of_a_torn_walk(false), 0.3);
  EXPECT_LT(error_of_a_torn_walk(true), 0.3 * error_of_a_torn_walk(false));
}

// Only a camera that turns about all its axes shows its lens.
std::vector<SE3> turning_walk() {
  std::vector<SE3> poses;
  for (int i = 0; i < 25; ++i) {
    const Eigen::Quaterniond turned =
        so3_exp({0.2 * std::sin(2 * i), 0.2 * std::cos(2 * i), 1.2 * std::sin(i)});
    poses.push_back(along(i * 0.08) * SE3(turned, {0, 0, 0.05 * i}));
  }
  return poses;
}

TEST(LensRefinement, FindsWhatTheCalibrationGetsWrong) {
  const LensCorrection lens{{0.01, 0.01, 0, 2, -3}};
  PointWorld world(40, {.count = 3000, .noise = 0.2, .lens = lens});
  Map map = testing::true_map(world, turning_walk());
  ASSERT_TRUE(adjust_fully(map, {}, nullptr).usable);
  const double bent = errors_of(map, world).median;
  const AdjustmentSummary summary = refine_lens(map, {}, nullptr);
  ASSERT_TRUE(summary.usable) << summary.to_string();
  EXPECT_LT(errors_of(map, world).median, 0.7 * bent);
  const auto& found = map.lens().values;
  EXPECT_NEAR(found[0], 0.01, 0.003);
  EXPECT_NEAR(found[1], 0.01, 0.003);
  EXPECT_NEAR(found[3], 2, 1);
  EXPECT_NEAR(found[4], -3, 1);
}

// Errors that a point keeps from frame to frame look a little like those of a lens.
TEST(LensRefinement, LeavesACalibrationAloneThatIsRight) {
  for (int seed = 41; seed < 44; ++seed) {
    PointWorld world(seed, {.noise = 0.6, .memory = 0.95});
    Map map = testing::true_map(world, turning_walk());
    ASSERT_TRUE(adjust_fully(map, {}, nullptr).usable);
    const std::vector<double> before = numbers_of(map);
    EXPECT_FALSE(refine_lens(map, {}, nullptr).usable);
    EXPECT_TRUE(map.lens().is_identity());
    EXPECT_EQ(numbers_of(map), before);
  }
}

TEST(LensRefinement, OfAnEmptyMapIsRefused) {
  Map map(testing::point_view());
  EXPECT_FALSE(refine_lens(map, {}, nullptr).usable);
}

TEST(FullAdjustment, FindsHowTheShutterRolls) {
  RollingWalk walk(0.025);
  ASSERT_TRUE(adjust_fully(walk.map, {}, nullptr).usable);
  EXPECT_NEAR(walk.map.readout(), 0.025, 0.001);
  EXPECT_LT(walk.worst_rotation_deg(), 0.1);

  RollingWalk blind(0.025);
  AdjustmentOptions options;
  options.estimate_readout = false;
  ASSERT_TRUE(adjust_fully(blind.map, options, nullptr).usable);
  EXPECT_EQ(blind.map.readout(), 0);
  EXPECT_GT(blind.worst_rotation_deg(), 2 * walk.worst_rotation_deg());
}

TEST(FullAdjustment, FindsThatAShutterDoesNotRoll) {
  RollingWalk walk(1e-9);  // its frames say where rows were read
  ASSERT_TRUE(adjust_fully(walk.map, {}, nullptr).usable);
  EXPECT_NEAR(walk.map.readout_estimate(), 0, 0.001);
  EXPECT_EQ(walk.map.readout(), 0);
}

TEST(LocalAdjustment, LearnsHowTheShutterRollsStepByStep) {
  RollingWalk walk(0.025);
  double before = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(adjust_locally(walk.map, walk.map.newest(), {}, nullptr).usable);
    EXPECT_GT(walk.map.readout_estimate(), before - 0.001);
    before = walk.map.readout_estimate();
  }
  EXPECT_NEAR(walk.map.readout(), 0.025, 0.002);
}

TEST(FullAdjustment, ErasesObservationsThatAreWrong) {
  PointWorld world(32, {.noise = 0.2});
  Map map = testing::true_map(world, walk(6, 0.25));
  const int before = observations_of(map);
  // Clutter is taken for points that the keyframe does not see.
  std::vector<std::pair<PointId, KeyframeId>> wrong;
  for (const KeyframeId id : keyframes_of(map)) {
    const Keyframe& k = map.keyframes()[id];
    std::vector<PointId> strangers;
    map.points().for_each([&](PointId p, const MapPoint&) {
      if (map.keypoint_of(p, id) < 0) strangers.push_back(p);
    });
    for (std::uint32_t i = 0; i < k.frame->size() && !strangers.empty(); ++i) {
      if (world.point_of(*k.frame, i) >= 0 || i % 2 == 0) continue;
      map.add_observation(strangers.back(), id, i);
      wrong.emplace_back(strangers.back(), id);
      strangers.pop_back();
    }
  }
  ASSERT_GT(wrong.size(), 100u);
  disturb(map, 2, 0.01, 0.02, 0.02);
  const AdjustmentSummary summary = adjust_fully(map, {}, nullptr);
  ASSERT_TRUE(summary.usable);
  int left = 0;
  for (const auto& [p, k] : wrong) left += map.points().contains(p) && map.keypoint_of(p, k) >= 0;
  EXPECT_LE(left, static_cast<int>(wrong.size()) / 20);
  EXPECT_GT(observations_of(map), 0.75 * before);
  EXPECT_GE(summary.outliers, static_cast<int>(wrong.size()) - left - 20);
  EXPECT_LT(errors_of(map, world).camera, 0.06);
  EXPECT_EQ(broken_links(map), "");
}

TEST(FullAdjustment, OfAnEmptyMapIsRefused) {
  Map map(testing::point_view());
  EXPECT_FALSE(adjust_fully(map, {}, nullptr).usable);
}

TEST(LocalAdjustment, BringsTheWindowBackToTheTruth) {
  PointWorld world(33, {.noise = 0.2});
  Map map = testing::true_map(world, walk(8, 0.2));
  const auto ids = keyframes_of(map);
  Random random(4);
  for (std::size_t i = 5; i < 8; ++i) {
    Keyframe& k = map.keyframes()[ids[i]];
    k.T_wc = k.T_wc * random.motion(0.01, 0.03);
  }
  EXPECT_GT(errors_of(map, world).camera, 0.025);
  const AdjustmentSummary summary = adjust_locally(map, ids.back(), {}, nullptr);
  EXPECT_TRUE(summary.usable) << summary.to_string();
  EXPECT_LT(errors_of(map, world).camera, 0.015);
  EXPECT_EQ(broken_links(map), "");
}

TEST(LocalAdjustment, LeavesKeyframesOutsideOfItsWindowWhereTheyAre) {
  PointWorld world(34);
  Map map = testing::true_map(world, walk(8, 0.25));
  const auto ids = keyframes_of(map);
  disturb(map, 5, 0.005, 0.01, 0.01);
  std::map<KeyframeId, SE3> before;
  for (const KeyframeId id : ids) before[id] = map.keyframes()[id].T_wc;
  AdjustmentOptions options;
  options.window = 3;
  ASSERT_TRUE(adjust_locally(map, ids.back(), options, nullptr).usable);
  int moved = 0;
  for (const KeyframeId id : ids) {
    const SE3& now = map.keyframes()[id].T_wc;
    moved += (now.matrix() - before[id].matrix()).norm() > 0;
  }
  EXPECT_GT(moved, 0);
  EXPECT_LE(moved, 3);
  EXPECT_GT((map.keyframes()[ids.back()].T_wc.matrix() - before[ids.back()].matrix()).norm(), 0);
  for (int i : {0, 1, 2}) {
    EXPECT_EQ((map.keyframes()[ids[i]].T_wc.matrix() - before[ids[i]].matrix()).norm(), 0) << i;
  }
}

TEST(LocalAdjustment, ErasesObservationsThatAreWrong) {
  PointWorld world(35);
  Map map = testing::true_map(world, walk(6, 0.2));
  const KeyframeId newest = map.newest();
  const Frame& frame = *map.keyframes()[newest].frame;
  std::vector<PointId> strangers;  // points that the newest does not see
  map.points().for_each([&](PointId id, const MapPoint&) {
    if (map.keypoint_of(id, newest) < 0) strangers.push_back(id);
  });
  std::vector<PointId> wrong;
  for (std::uint32_t i = 0; i < frame.size() && wrong.size() < strangers.size(); ++i) {
    if (world.point_of(frame, i) >= 0) continue;
    map.add_observation(strangers[wrong.size()], newest, i);
    wrong.push_back(strangers[wrong.size()]);
  }
  ASSERT_GT(wrong.size(), 20u);
  ASSERT_TRUE(adjust_locally(map, newest, {}, nullptr).usable);
  int left = 0;
  for (const PointId p : wrong) left += map.points().contains(p) && map.keypoint_of(p, newest) >= 0;
  EXPECT_LE(left, static_cast<int>(wrong.size()) / 10);
  EXPECT_EQ(broken_links(map), "");
}

TEST(LocalAdjustment, LeavesWhatWasAddedToCornersToTheFullOne) {
  PointWorld world(35, {.noise = 0.2});
  Map map = testing::true_map(world, walk(6, 0.2)), plain = map;
  Keyframe& newest = map.keyframes()[map.newest()];
  auto frame = std::make_shared<Frame>(*newest.frame);
  std::vector<PointId> strangers;  // points that the newest does not see
  map.points().for_each([&](PointId id, const MapPoint&) {
    if (map.keypoint_of(id, map.newest()) < 0) strangers.push_back(id);
  });
  ASSERT_GT(strangers.size(), 20u);
  for (const PointId p : strangers) {
    frame->add({}, {}, 0, Eigen::Vector2d::Zero());  // in a corner of the picture: all wrong
    newest.points.emplace_back();
    map.add_observation(p, map.newest(), static_cast<std::uint32_t>(frame->size() - 1));
  }
  newest.frame = frame;
  const auto left = [&] {
    return std::count_if(strangers.begin(), strangers.end(), [&](PointId p) {
      return map.points().contains(p) && map.keypoint_of(p, map.newest()) >= 0;
    });
  };
  ASSERT_TRUE(adjust_locally(map, map.newest(), {}, nullptr).usable);
  ASSERT_TRUE(adjust_locally(plain, plain.newest(), {}, nullptr).usable);
  EXPECT_EQ(left(), std::ssize(strangers));
  const SE3& as_if_they_were_not = plain.keyframes()[plain.newest()].T_wc;
  EXPECT_LT((newest.T_wc.matrix() - as_if_they_were_not.matrix()).norm(), 1e-6);
  ASSERT_TRUE(adjust_fully(map, {}, nullptr).usable);
  EXPECT_LE(left(), std::ssize(strangers) / 10);
  EXPECT_EQ(broken_links(map), "");
}

TEST(Adjustment, StopsEarlyWhenAskedToAndLeavesAUsableMap) {
  PointWorld world(36);
  Map map = testing::true_map(world, walk(6, 0.3));
  disturb(map, 6, 0.002, 0.002, 0.002);
  const int before = observations_of(map);
  const StopAsked stop = [] { return true; };
  for (int round = 0; round < 2; ++round) {
    const AdjustmentSummary summary =
        round == 0 ? adjust_locally(map, map.newest(), {}, stop) : adjust_fully(map, {}, stop);
    EXPECT_TRUE(summary.stopped);
    EXPECT_LE(summary.iterations, 2);
    EXPECT_EQ(summary.outliers, 0);
    EXPECT_EQ(broken_links(map), "");
    EXPECT_GT(observations_of(map), before / 2);
    EXPECT_LT(errors_of(map, world).camera, 0.05);
  }
}

TEST(Adjustment, SameMapSameBytes) {
  auto run = [] {
    PointWorld world(37);
    Map map = testing::true_map(world, walk(7, 0.25));
    disturb(map, 7, 0.01, 0.02, 0.02);
    adjust_locally(map, map.newest(), {}, nullptr);
    adjust_fully(map, {}, nullptr);
    return numbers_of(map);
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace cairn
