#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "blackout.h"
#include "cairn/datasets/groundtruth.h"
#include "cairn/datasets/sequence.h"
#include "cairn/evaluation/evaluation.h"

namespace cairn {
namespace {

// Where recorded sequences are: $CAIRN_DATA, or shared/data beside the project.
std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("CAIRN_DATA")) return folder;
  return std::filesystem::path(CAIRN_SOURCE_DIR).parent_path() / "shared" / "data";
}

#define SKIP_WITHOUT(sequence)                                                               \
  if (!std::filesystem::exists(data_folder() / (sequence))) {                                \
    GTEST_SKIP() << (data_folder() / (sequence)).string()                                    \
                 << " is not there; set CAIRN_DATA to the folder that holds " << (sequence); \
  }

struct Played {
  SlamResult result;
  std::vector<FrameRecord> frames;
  std::vector<double> times;
};

Played play(const std::string& sequence_name, int frames, const Blackout& blackout = {}) {
  Sequence sequence = open_sequence((data_folder() / sequence_name).string());
  Options options;
  options.pace = Pace::kLockstep;
  Slam slam(sequence.camera.value(), options);
  Played played;
  SourceFrame frame;
  for (int i = 0; i < frames && sequence.frames->next(frame); ++i) {
    EXPECT_EQ(frame.problem, "");
    slam.process(blackout(i, frame.image), frame.timestamp);
    played.times.push_back(frame.timestamp);
  }
  played.result = slam.finish();
  played.frames = slam.frames();
  return played;
}

EvaluationReport compare(const Played& played, const std::string& groundtruth) {
  return evaluate(read_groundtruth(data_folder() / groundtruth), played.result.trajectory, {},
                  played.times);
}

TEST(RealData, RedKitchenFindsItsPlaceAgainAfterABlackout) {
  SKIP_WITHOUT("redkitchen");
  const Blackout blackout{150, 165};
  const Played played = play("redkitchen", 300, blackout);
  ASSERT_EQ(played.result.refusal, "");
  EXPECT_EQ(played.result.restarts, 0);
  ASSERT_GE(played.result.gaps.size(), 1u);
  EXPECT_EQ(recoveries(played.result), static_cast<int>(played.result.gaps.size()));
  EXPECT_NEAR(played.result.gaps[0].lost, played.times[blackout.begin], 1e-6);
  EXPECT_LT(played.result.gaps[0].recovered, played.times[blackout.end] + 1);
  const EvaluationReport report = compare(played, "redkitchen/groundtruth_sfm.txt");
  EXPECT_GT(report.coverage, 0.8);
  EXPECT_LT(report.ate.rmse, 0.02);
}

TEST(RealData, Freiburg1IsTrackedWithinCentimetres) {
  SKIP_WITHOUT("tum_fr1_xyz");
  const Played played = play("tum_fr1_xyz", 250);
  ASSERT_EQ(played.result.refusal, "");
  const EvaluationReport report = compare(played, "tum_fr1_xyz/groundtruth.txt");
  EXPECT_GT(report.coverage, 0.7);
  EXPECT_LT(report.ate.rmse, 0.025);
  EXPECT_NEAR(played.result.readout, 0.026, 0.008) << "the first Kinect's shutter rolls";
}

TEST(RealData, KittiIsTrackedAlongItsStreet) {
  SKIP_WITHOUT("kitti_00");
  const Played played = play("kitti_00", 100);
  ASSERT_EQ(played.result.refusal, "");
  const EvaluationReport report = compare(played, "kitti_00/poses/00.txt");
  EXPECT_GT(report.coverage, 0.8);
  EXPECT_LT(report.ate.rmse, 0.25);
  EXPECT_EQ(played.result.readout, 0) << "this camera's shutter does not roll";
}

}  // namespace
}  // namespace cairn
