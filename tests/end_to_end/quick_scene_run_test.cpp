#include <gtest/gtest.h>

#include "blackout.h"
#include "cairn/evaluation/evaluation.h"
#include "quick_scene/quick_scene.h"

namespace cairn {
namespace {

struct Played {
  SlamResult result;
  Trajectory truth;
  std::vector<FrameRecord> frames;
};

Played play(std::uint64_t seed, int frames, const Blackout& blackout = {}) {
  const QuickScene scene(seed);
  Options options;
  options.pace = Pace::kLockstep;
  Slam slam(scene.camera(), options);
  Played played;
  for (int i = 0; i < frames; ++i) {
    const double t = i / 30.0;
    slam.process(blackout(i, scene.render(t)), t);
    played.truth.push_back({t, scene.T_wc(t)});
  }
  played.result = slam.finish();
  played.frames = slam.frames();
  return played;
}

TEST(QuickSceneRun, FiveSecondsAreTrackedWithinMillimetres) {
  const Played played = play(7, 150);
  ASSERT_EQ(played.result.refusal, "");
  const EvaluationReport report = evaluate(played.truth, played.result.trajectory);
  EXPECT_LT(report.ate.rmse, 0.002) << "metres; the camera is about 1.7 m from the desk";
  EXPECT_LT(report.ate.max, 0.006);
  EXPECT_LT(report.frame.rotation_deg.value(), 0.1);
  EXPECT_GT(report.coverage, 0.9);
  EXPECT_TRUE(played.result.gaps.empty());
}

TEST(QuickSceneRun, FindsItsPlaceAgainAfterABlackout) {
  const Blackout blackout{170, 185};
  const Played played = play(2, 220, blackout);
  ASSERT_EQ(played.result.refusal, "");
  ASSERT_EQ(played.result.gaps.size(), 1u);
  const SlamResult::Gap& gap = played.result.gaps[0];
  EXPECT_NEAR(gap.lost, blackout.begin / 30.0, 1e-9) << "lost with the first black frame";
  EXPECT_GE(gap.recovered, blackout.end / 30.0 - 1e-9);
  EXPECT_LT(gap.recovered, blackout.end / 30.0 + 0.5);
  EXPECT_EQ(played.result.restarts, 0);
  for (int i = blackout.begin; i < blackout.end; ++i) {
    EXPECT_EQ(played.frames[i].state, FrameState::kLost);
  }
  const EvaluationReport report = evaluate(played.truth, played.result.trajectory);
  EXPECT_GT(report.coverage, 0.8);
  EXPECT_LT(report.ate.rmse, 0.003);
}

}  // namespace
}  // namespace cairn
