#include "cairn/evaluation/evaluation.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

SE3 at(double x, double y, double z) { return {Eigen::Quaterniond::Identity(), {x, y, z}}; }

// A curve in space that turns, 10 poses a second.
Trajectory spiral(std::size_t count) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.1 * double(i);
    trajectory.push_back(
        {100 + t, SE3(so3_exp({0.1 * t, 0.3 * t, -0.2 * t}), {std::cos(t), std::sin(t), 0.2 * t})});
  }
  return trajectory;
}

Trajectory transformed(const Trajectory& trajectory, const SE3& T, double scale) {
  Trajectory result;
  for (const auto& [t, T_wc] : trajectory) {
    const SE3 moved = T * T_wc;
    result.push_back({t, SE3(moved.rotation(), scale * moved.translation())});
  }
  return result;
}

TEST(Associate, PairsTheNearestWithinTheLimit) {
  const std::vector<double> truth = {0, 0.1, 0.2, 0.3, 0.4}, estimate = {0.104, 0.195, 0.35};
  const auto pairs = associate(truth, estimate, 0.01);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].first, 1u);
  EXPECT_EQ(pairs[0].second, 0u);
  EXPECT_EQ(pairs[1].first, 2u);
  EXPECT_EQ(pairs[1].second, 1u);
}

TEST(Associate, AddsTheOffsetToTheSecondList) {
  const std::vector<double> truth = {10, 11, 12}, estimate = {0, 1, 2, 3};
  EXPECT_EQ(associate(truth, estimate, 0.01, 10).size(), 3u);
  EXPECT_EQ(associate(estimate, truth, 0.01, -10).size(), 3u);
  EXPECT_EQ(associate(truth, estimate, 0.01).size(), 0u);
}

TEST(Associate, UsesEachTimestampOnce) {
  const std::vector<double> truth = {1.000, 2, 3, 4}, estimate = {0.994, 1.002, 1.008};
  const auto pairs = associate(truth, estimate, 0.01);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].second, 1u);
}

TEST(Associate, TakesEmptyLists) {
  EXPECT_TRUE(associate({}, {}, 1).empty());
  EXPECT_TRUE(associate(std::vector<double>{1}, {}, 1).empty());
}

TEST(CommonPoses, AreThoseOfTheFramesThatBothHave) {
  const Trajectory all = spiral(10);
  Trajectory some(all.begin() + 2, all.begin() + 5);
  some.push_back({all.back().timestamp + 1, SE3()});
  for (StampedPose& pose : some) pose.timestamp += 2e-4, pose.T_wc = SE3();
  const Trajectory common = common_poses(all, some);
  ASSERT_EQ(common.size(), 3U);
  for (std::size_t i = 0; i < common.size(); ++i) {
    EXPECT_EQ(common[i].timestamp, all[i + 2].timestamp);
    EXPECT_EQ(common[i].T_wc.matrix(), all[i + 2].T_wc.matrix());
  }
  EXPECT_TRUE(common_poses(all, {}).empty());
}

TEST(AlignTrajectory, FindsAKnownTransformExactly) {
  const Trajectory truth = spiral(30);
  const SE3 T(so3_exp({0.4, -1.2, 2.0}), {5, -3, 1});
  const Trajectory moved = transformed(truth, T, 0.25);
  std::vector<Vector3d> from, to;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    from.push_back(moved[i].T_wc.translation());
    to.push_back(truth[i].T_wc.translation());
  }
  const TrajectoryAlignment alignment = align_trajectory(from, to, Alignment::kSim3);
  EXPECT_NEAR(alignment.scale, 4, 1e-12);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((alignment * from[i] - to[i]).norm(), 1e-12);
    const SE3 error = truth[i].T_wc.inverse() * (alignment * moved[i].T_wc);
    EXPECT_LT(error.log().norm(), 1e-9);
  }
}

TEST(AlignViews, TurnsAsTheCamerasDoWhereTheirPathIsShort) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.004);
  const SE3 T(so3_exp({0.4, -1.2, 2.0}), {5, -3, 1});
  std::vector<SE3> from, to;
  std::vector<Vector3d> from_position, to_position;
  for (int i = 0; i < 40; ++i) {
    to.emplace_back(so3_exp({0.01 * i, 0.3, 0}), Vector3d(0.01 * i, 0.02 * std::sin(i), 0));
    const Vector3d off(noise(random), noise(random), noise(random));
    from.push_back(T * SE3(to.back().rotation(), to.back().translation() + off));
    from_position.push_back(from.back().translation());
    to_position.push_back(to.back().translation());
  }
  const auto by_path = align_trajectory(from_position, to_position, Alignment::kSE3);
  const auto by_views = align_views(by_path, from, to);
  const Eigen::Quaterniond truth = T.rotation().conjugate();
  EXPECT_GT(by_path.T.rotation().angularDistance(truth), 0.01);
  EXPECT_LT(by_views.T.rotation().angularDistance(truth), 1e-6);
  EXPECT_LT((by_views * T.translation() - Vector3d::Zero()).norm(), 0.005);
}

TEST(AlignViews, KeepsToThePathWhereTheTruthIsOfAnotherCamera) {
  std::vector<SE3> from, to;
  for (int i = 0; i < 5; ++i) {
    from.push_back(at(i, i * i, 0));
    to.emplace_back(so3_exp({0, 1.5, 0}), Vector3d(i, i * i, 0));
  }
  const TrajectoryAlignment by_path;
  EXPECT_TRUE(align_views(by_path, from, to).T.matrix() == by_path.T.matrix());
}

TEST(AlignTrajectory, IsARotationAlsoWhereAReflectionFitsBetter) {
  const std::vector<Vector3d> from = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-1, -1, -1}};
  std::vector<Vector3d> to;
  for (const Vector3d& x : from) to.push_back({-x.x(), x.y(), x.z()});
  EXPECT_NEAR(align_trajectory(from, to, Alignment::kSE3).T.matrix3().determinant(), 1, 1e-12);
}

TEST(AlignTrajectory, RefusesWhatIsNotDetermined) {
  const auto reason = [](const std::vector<Vector3d>& from, const std::vector<Vector3d>& to) {
    try {
      align_trajectory(from, to, Alignment::kSim3);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::vector<Vector3d> spread = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Vector3d> line = {{0, 0, 0}, {1, 2, 0}, {2, 4, 0}};
  const std::vector<Vector3d> still(3, Vector3d(1, 2, 3));
  EXPECT_THAT(reason({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}), HasSubstr("three"));
  EXPECT_THAT(reason(line, spread), HasSubstr("one line"));
  EXPECT_THAT(reason(still, spread), HasSubstr("the estimate does not move"));
  EXPECT_THAT(reason(spread, still), HasSubstr("the ground truth does not move"));
  EXPECT_THAT(reason({{0, 0, NAN}, {1, 0, 0}, {0, 1, 0}}, spread), HasSubstr("not finite"));
  EXPECT_NO_THROW(align_trajectory(line, spread, Alignment::kNone));
}

TEST(Statistics, AreThoseComputedByHand) {
  const ErrorStatistics s = statistics({3, 1, 2, 6});
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.max, 6);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));
}

TEST(Evaluate, FindsNoErrorInAMovedAndScaledCopy) {
  const Trajectory truth = spiral(100);
  const auto report = evaluate(truth, transformed(truth, SE3(so3_exp({1, 2, 3}), {4, 5, 6}), 0.5));
  EXPECT_EQ(report.pairs, 100u);
  EXPECT_NEAR(report.scale, 2, 1e-9);
  EXPECT_NEAR(*report.scale_error, 1, 1e-9);
  EXPECT_LT(report.ate.max, 1e-9);
  EXPECT_LT(*report.metre.translation, 1e-9);
  EXPECT_LT(*report.second.rotation_deg, 1e-6);
  EXPECT_DOUBLE_EQ(report.coverage, 1);
}

// Truth: a straight walk of 0.5 m a frame in x. Estimate: the same with 0.1 m sideways at every
// second frame, and 3 degrees of turn from frame 4 on.
TEST(Evaluate, AgreesWithFiguresComputedByHand) {
  Trajectory truth, estimate;
  for (int i = 0; i < 8; ++i) {
    truth.push_back({double(i), at(0.5 * i, 0, 0)});
    const Eigen::Quaterniond turn = so3_exp({0, 0, i >= 4 ? 3 * M_PI / 180 : 0.0});
    estimate.push_back({double(i), SE3(turn, {0.5 * i, i % 2 == 0 ? 0.0 : 0.1, 0})});
  }
  EvaluationOptions options;
  options.alignment = Alignment::kNone;
  const auto report = evaluate(truth, estimate, options);
  EXPECT_NEAR(report.ate.rmse, std::sqrt(4 * 0.01 / 8), 1e-12);
  EXPECT_NEAR(report.ate.median, 0.05, 1e-12);
  EXPECT_NEAR(report.ate.max, 0.1, 1e-12);
  // Motions i to i+1: the estimate goes (0.5, ±0.1), seen from a camera that is turned by 3 degrees
  // from i = 4 on. The turn itself happens once in seven pairs.
  EXPECT_NEAR(*report.frame.rotation_deg, std::sqrt(9.0 / 7), 1e-9);
  const double c = std::cos(3 * M_PI / 180), s = std::sin(3 * M_PI / 180);
  double sum = 4 * 0.01;
  for (int i = 4; i < 7; ++i) {
    const double dy = i % 2 == 0 ? 0.1 : -0.1;
    const double x = c * 0.5 + s * dy - 0.5, y = -s * 0.5 + c * dy;
    sum += x * x + y * y;
  }
  EXPECT_EQ(report.frame.pairs, 7u);
  EXPECT_NEAR(*report.frame.translation, std::sqrt(sum / 7), 1e-12);
  EXPECT_NEAR(*report.second.translation, *report.frame.translation, 1e-12);  // 1 frame a second
}

TEST(PairsByPath, SetAMarkWheneverAMetreHasBeenGone) {
  Trajectory walk;
  for (int i = 0; i < 12; ++i) walk.push_back({double(i), at(0.375 * i, 0, 0)});
  // Marks at 1.125 m = 3 steps: 3, 6, 9.
  const auto pairs = pairs_by_path(walk, 1);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].first, 3u);
  EXPECT_EQ(pairs[0].second, 6u);
  EXPECT_EQ(pairs[1].second, 9u);
  EXPECT_TRUE(pairs_by_path(walk, 10).empty());
  EXPECT_TRUE(pairs_by_path({}, 1).empty());
}

TEST(PairsByTime, LeaveGapsOut) {
  Trajectory poses;
  for (const double t : {0.0, 0.5, 1.02, 1.5, 4.0, 4.5, 5.0}) poses.push_back({t, {}});
  const auto pairs = pairs_by_time(poses, 1);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].second, 2u);  // 0 and 1.02
  EXPECT_EQ(pairs[1].second, 3u);  // 0.5 and 1.5
  EXPECT_EQ(pairs[2].first, 4u);   // 4 and 5
}

TEST(Evaluate, CountsCoverageOverTheFramesThatHaveATruth) {
  const Trajectory truth = spiral(100);  // every 0.1 s
  std::vector<double> frames;            // every 0.05 s, and 2 s beyond the truth
  for (int i = 0; i < 240; ++i) frames.push_back(100 + 0.05 * i);
  Trajectory estimate(truth.begin() + 20, truth.end());
  const auto report = evaluate(truth, estimate, {}, frames);
  EXPECT_EQ(report.frames_with_truth, 100u);
  EXPECT_DOUBLE_EQ(report.coverage, 0.8);
}

TEST(Evaluate, GuessesCoverageWithoutTheFrames) {
  const Trajectory truth = spiral(100);
  Trajectory gap(truth.begin(), truth.begin() + 30);
  gap.insert(gap.end(), truth.begin() + 50, truth.end());
  EXPECT_DOUBLE_EQ(evaluate(truth, gap).coverage, 0.8);
  Trajectory third;  // 3.33 frames a second, all tracked
  for (std::size_t i = 0; i < 100; i += 3) third.push_back(truth[i]);
  EXPECT_DOUBLE_EQ(evaluate(truth, third).coverage, 1);
}

TEST(Evaluate, ShiftsTheEstimateByTheOffset) {
  const Trajectory truth = spiral(50);
  Trajectory late = truth;
  for (auto& pose : late) pose.timestamp += 7.5;
  EvaluationOptions options;
  options.offset = -7.5;
  std::vector<double> frames;
  for (const auto& pose : late) frames.push_back(pose.timestamp);
  const auto report = evaluate(truth, late, options, frames);
  EXPECT_LT(report.ate.max, 1e-9);
  EXPECT_DOUBLE_EQ(report.coverage, 1);
}

TEST(Evaluate, LeavesTheScaleAloneWithSe3) {
  const Trajectory truth = spiral(60);
  EvaluationOptions options;
  options.alignment = Alignment::kSE3;
  const auto report =
      evaluate(truth, transformed(truth, SE3(so3_exp({1, 0, 0}), {1, 1, 1}), 0.8), options);
  EXPECT_EQ(report.scale, 1);
  EXPECT_NEAR(*report.scale_error, 0.25, 1e-9);
  EXPECT_GT(report.ate.rmse, 0.05);
}

TEST(Evaluate, SaysWhyTwoTrajectoriesCannotBeCompared) {
  const auto reason = [](const Trajectory& truth, const Trajectory& estimate) {
    try {
      evaluate(truth, estimate);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::kInput);
      return std::string(e.what());
    }
    return std::string();
  };
  Trajectory later = spiral(10);
  for (auto& pose : later) pose.timestamp += 1000;
  EXPECT_THAT(reason(spiral(10), later), HasSubstr("same sequence"));
  EXPECT_THAT(reason(spiral(10), {}), HasSubstr("nothing was tracked"));
  EXPECT_THAT(reason({}, later), HasSubstr("ground truth holds no poses"));
  EXPECT_THAT(reason(spiral(10), spiral(2)), HasSubstr("three"));
  EXPECT_THROW(parse_alignment("sim"), Error);
}

TEST(EvaluationReport, HasTheKeysThatScriptsReadAndATableForPeople) {
  const Trajectory truth = spiral(12);
  const auto report = evaluate(truth, truth);
  const nlohmann::json json = to_json(report);
  EXPECT_EQ(json.at("pairs"), 12);
  for (const char* path :
       {"/coverage", "/scale", "/scale_error", "/ate/rmse", "/ate/median", "/ate/max",
        "/rpe/frame/translation", "/rpe/second/rotation_deg", "/rpe/metre/translation"}) {
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(path))) << path;
  }
  EXPECT_TRUE(json.at("rpe").at("metre").at("translation").is_null());  // 1.1 m in all
  EXPECT_THAT(to_table(report), HasSubstr("ATE RMSE"));
}

}  // namespace
}  // namespace cairn
