#include "cairn/system/slam.h"

#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <set>
#include <thread>

#include "quick_scene/quick_scene.h"

namespace cairn {
namespace {

constexpr int kFrames = 70;

const QuickScene& scene() {
  static const QuickScene scene(5);
  return scene;
}

const std::vector<cv::Mat>& pictures() {
  static const std::vector<cv::Mat> pictures = [] {
    std::vector<cv::Mat> result;
    for (int i = 0; i < kFrames; ++i) result.push_back(scene().render(i / 30.0));
    return result;
  }();
  return pictures;
}

// Knows the scene: its depth and its floor, and who asked, and when.
class KnowingDetector : public PlaneDetector {
 public:
  struct Record {
    std::shared_future<void> may_look;  // waits for it, if there is one
    std::mutex mutex;
    std::set<std::thread::id> threads;
    std::set<double> times;
  };
  explicit KnowingDetector(Record& record) : record_(record) {}

  DetectedFrame detect(const PerceptionInput& input) override {
    const std::lock_guard lock(record_.mutex);
    record_.threads.insert(std::this_thread::get_id());
    EXPECT_TRUE(record_.times.insert(input.timestamp).second) << "looked at twice";
    if (record_.may_look.valid()) record_.may_look.wait();
    const SE3 T_wc = scene().T_wc(input.timestamp);
    DetectedFrame frame;
    frame.timestamp = input.timestamp;
    frame.depth = cv::Mat::zeros(48, 64, CV_32F);
    cv::Mat floor = cv::Mat::zeros(48, 64, CV_8U);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        const Eigen::Vector3d ray =
            scene().camera().unproject({10 * (x + 0.5) - 0.5, 10 * (y + 0.5) - 0.5});
        const auto along = scene().cast(T_wc.translation(), T_wc.rotation() * ray);
        if (!along) continue;
        frame.depth.at<float>(y, x) = float(*along * ray.z());
        const double height = (T_wc * Eigen::Vector3d(*along * ray)).z();
        floor.at<unsigned char>(y, x) = height < 1e-6 ? 255 : 0;
      }
    }
    DetectedPlane plane;
    plane.plane.head<3>() = T_wc.rotation().conjugate() * Eigen::Vector3d::UnitZ();
    plane.plane[3] = T_wc.translation().z();
    plane.label = "floor";
    plane.score = 1;
    plane.sigma_angle = plane.sigma_depth = 0.02;
    cv::resize(floor, plane.mask, {640, 480}, 0, 0, cv::INTER_NEAREST);
    if (cv::countNonZero(plane.mask) > 5000) frame.planes.push_back(plane);
    return frame;
  }

 private:
  Record& record_;
};

struct Played {
  SlamResult result;
  std::vector<FrameRecord> frames;
};

Played play(const Options& options) {
  Slam slam(scene().camera(), options);
  for (int i = 0; i < kFrames; ++i) slam.process(pictures()[i], i / 30.0);
  Played played;
  played.result = slam.finish();
  played.frames = slam.frames();
  return played;
}

Options lockstep(int threads) {
  Options options;
  options.pace = Pace::kLockstep;
  options.threads = threads;
  return options;
}

// All numbers of a result, to be compared bit by bit.
std::vector<double> numbers_of(const SlamResult& result) {
  std::vector<double> numbers;
  for (const Trajectory* t : {&result.trajectory, &result.trajectory_live, &result.keyframes}) {
    for (const StampedPose& p : *t) {
      numbers.push_back(p.timestamp);
      for (int i = 0; i < 4; ++i) numbers.push_back(p.T_wc.rotation().coeffs()[i]);
      for (int i = 0; i < 3; ++i) numbers.push_back(p.T_wc.translation()[i]);
    }
  }
  for (const SlamResult::Point& p : result.points) {
    for (int i = 0; i < 3; ++i) numbers.push_back(p.position[i]);
  }
  return numbers;
}

TEST(Slam, InLockstepTheResultIsTheSameToTheLastBitWithAnyNumberOfThreads) {
  const Played one = play(lockstep(1)), again = play(lockstep(1)), two = play(lockstep(2));
  ASSERT_GT(one.result.trajectory.size(), kFrames / 2u) << one.result.refusal;
  EXPECT_EQ(numbers_of(one.result), numbers_of(again.result)) << "two runs differ";
  EXPECT_EQ(numbers_of(one.result), numbers_of(two.result)) << "one and two threads differ";
  ASSERT_EQ(one.frames.size(), two.frames.size());
  for (std::size_t i = 0; i < one.frames.size(); ++i) {
    EXPECT_EQ(one.frames[i].state, two.frames[i].state);
    EXPECT_EQ(one.frames[i].inliers, two.frames[i].inliers);
    EXPECT_EQ(one.frames[i].keyframe, two.frames[i].keyframe);
  }
}

TEST(Slam, InRealtimeItMakesAMapOfTheSameFrames) {
  Options options;
  options.pace = Pace::kRealtime;
  const Played realtime = play(options);
  EXPECT_GT(realtime.result.trajectory.size(), kFrames / 2u) << realtime.result.refusal;
  EXPECT_GE(realtime.result.keyframes.size(), 2u);
  EXPECT_GT(realtime.result.points.size(), 100u);
}

TEST(Slam, InRealtimePicturesAreLookedAtOnAThreadOfTheirOwn) {
  KnowingDetector::Record record;
  Options options;
  options.pace = Pace::kRealtime;
  Slam slam(scene().camera(), options, std::make_unique<KnowingDetector>(record));
  std::size_t masks = 0;
  for (int i = 0; i < kFrames; ++i) masks += slam.process(pictures()[i], i / 30.0).planes.size();
  const SlamResult result = slam.finish([](const Slam::Finishing&) { return false; });
  EXPECT_GT(result.trajectory.size(), kFrames / 2u) << result.refusal;
  ASSERT_EQ(record.threads.size(), 1u);
  EXPECT_NE(*record.threads.begin(), std::this_thread::get_id());
  EXPECT_EQ(masks, 0u) << "they are of pictures that are gone";
}

TEST(Slam, InRealtimeKeyframesThatADetectorHadNoTimeForAreLookedAtInTheEnd) {
  KnowingDetector::Record record;
  std::promise<void> sequence_ended;
  record.may_look = sequence_ended.get_future().share();
  Options options;
  options.pace = Pace::kRealtime;
  Slam slam(scene().camera(), options, std::make_unique<KnowingDetector>(record));
  for (int i = 0; i < kFrames; ++i) slam.process(pictures()[i], i / 30.0);
  sequence_ended.set_value();
  std::size_t asked = 0, all = 0;
  const SlamResult result = slam.finish([&](const Slam::Finishing& finishing) {
    if (finishing.stage != Slam::Finishing::Stage::kLooking) return true;
    EXPECT_EQ(finishing.done, asked++);
    all = finishing.all;
    return true;
  });
  EXPECT_GT(all, 0u);
  EXPECT_EQ(asked, all);
  for (const StampedPose& keyframe : result.keyframes) {
    if (keyframe.timestamp > result.keyframes.front().timestamp) {
      EXPECT_TRUE(record.times.contains(keyframe.timestamp)) << keyframe.timestamp;
    }
  }
}

TEST(Slam, ItsAdjustmentInTheEndGoesStepByStepAndMayBeCutShort) {
  using Finishing = Slam::Finishing;
  const auto steps_of = [](std::size_t allowed, std::size_t& tracked) {
    Slam slam(scene().camera(), lockstep(0));
    for (int i = 0; i < kFrames; ++i) slam.process(pictures()[i], i / 30.0);
    std::size_t steps = 0;
    const SlamResult result = slam.finish([&](const Finishing& at) {
      EXPECT_EQ(at.stage, Finishing::Stage::kAdjusting);
      EXPECT_EQ(at.done, ++steps);
      EXPECT_LE(at.done, at.all);
      return steps <= allowed;
    });
    tracked = result.trajectory.size();
    return steps;
  };
  std::size_t tracked = 0, tracked_when_cut = 0;
  EXPECT_GT(steps_of(1000, tracked), 10u);
  EXPECT_LE(steps_of(2, tracked_when_cut), 6u) << "one look at each fit that is left";
  EXPECT_EQ(tracked, tracked_when_cut);
}

TEST(Slam, InLockstepADetectorThatKnowsGivesTheFloorAndMetres) {
  KnowingDetector::Record record;
  Slam slam(scene().camera(), lockstep(0), std::make_unique<KnowingDetector>(record));
  std::size_t masks = 0;
  for (int i = 0; i < kFrames; ++i) {
    const FrameResult frame = slam.process(pictures()[i], i / 30.0);
    EXPECT_TRUE(frame.planes.empty() || frame.record.keyframe);
    for (const DetectedPlane& plane : frame.planes)
      masks += plane.mask.size() == cv::Size(640, 480);
  }
  EXPECT_GT(masks, 0u);
  const SlamResult result = slam.finish();
  EXPECT_EQ(record.threads, std::set{std::this_thread::get_id()});
  ASSERT_EQ(result.scale.how, "measured depth");
  ASSERT_EQ(result.planes.size(), 1u);
  EXPECT_EQ(result.planes[0].label, "floor");
  const auto& keyframes = result.keyframes;
  const SE3 T_w0 = scene().T_wc(keyframes.front().timestamp);
  const Eigen::Vector3d up = T_w0.rotation().conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(std::abs(up.dot(result.planes[0].normal)), std::cos(1.5 * M_PI / 180));
  EXPECT_NEAR(std::abs(result.planes[0].d), T_w0.translation().z(), 0.05);
}

TEST(Slam, EveryFrameMayBeLookedAtAndTheMapStaysTheSame) {
  const auto run = [](bool every_frame, KnowingDetector::Record& record) {
    Options options = lockstep(1);
    options.look_at_every_frame = every_frame;
    Slam slam(scene().camera(), options, std::make_unique<KnowingDetector>(record));
    for (int i = 0; i < kFrames; ++i) {
      const FrameResult frame = slam.process(pictures()[i], i / 30.0);
      EXPECT_EQ(frame.planes.empty(), !every_frame && !frame.record.keyframe);
    }
    return numbers_of(slam.finish());
  };
  KnowingDetector::Record of_keyframes, of_all;
  const std::vector<double> numbers = run(false, of_keyframes);
  EXPECT_EQ(run(true, of_all), numbers);
  EXPECT_EQ(of_all.times.size(), std::size_t(kFrames));
  EXPECT_LT(of_keyframes.times.size(), std::size_t(kFrames));
}

TEST(Slam, InRealtimeEveryFrameMayBeLookedAtWithinItsCall) {
  KnowingDetector::Record record;
  Options options;
  options.pace = Pace::kRealtime;
  options.look_at_every_frame = true;
  Slam slam(scene().camera(), options, std::make_unique<KnowingDetector>(record));
  for (int i = 0; i < kFrames; ++i) slam.process(pictures()[i], i / 30.0);
  EXPECT_EQ(record.times.size(), std::size_t(kFrames));
  EXPECT_EQ(record.threads, std::set{std::this_thread::get_id()});
}

TEST(Slam, AGivenScaleMultipliesAllLengths) {
  const auto run = [](double factor) {
    KnowingDetector::Record record;
    Options options = lockstep(0);
    options.scale = factor;
    Slam slam(scene().camera(), options, std::make_unique<KnowingDetector>(record));
    for (int i = 0; i < kFrames; ++i) slam.process(pictures()[i], i / 30.0);
    return slam.finish();
  };
  const SlamResult found = run(0), given = run(1.25);
  EXPECT_EQ(given.scale.how, "given");
  EXPECT_EQ(given.scale.sigma, 0);
  EXPECT_NEAR(given.scale.value, 1.25 * found.scale.value, 1e-12);
  const auto last = [](const SlamResult& r) { return r.trajectory.back().T_wc.translation(); };
  EXPECT_LT((last(given) - 1.25 * last(found)).norm(), 1e-12);
  EXPECT_LT((given.points[0].position - 1.25 * found.points[0].position).norm(), 1e-12);
  ASSERT_EQ(given.planes.size(), 1u);
  EXPECT_NEAR(given.planes[0].d, 1.25 * found.planes[0].d, 1e-12);
}

TEST(Slam, TheWorldIsTheFirstKeyframe) {
  const Played one = play(lockstep(0));
  ASSERT_FALSE(one.result.keyframes.empty());
  EXPECT_LT(one.result.keyframes.front().T_wc.log().norm(), 1e-9);
}

TEST(Slam, HasARowForEveryFrame) {
  Slam slam(scene().camera(), lockstep(0));
  slam.process(pictures()[0], 0);
  slam.skip(0.1);
  slam.drop(0.2);
  slam.process(pictures()[1], 0.3);
  const auto& rows = slam.frames();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].state, FrameState::kInitialising);
  EXPECT_EQ(rows[1].state, FrameState::kSkipped);
  EXPECT_EQ(rows[2].state, FrameState::kDropped);
  EXPECT_EQ(rows[3].timestamp, 0.3);
}

TEST(Slam, WithoutAMapItSaysWhy) {
  Slam slam(scene().camera(), lockstep(0));
  const cv::Mat black = cv::Mat::zeros(480, 640, CV_8UC3);
  for (int i = 0; i < 3; ++i) {
    const FrameResult result = slam.process(black, i / 30.0);
    EXPECT_FALSE(result.T_wc.has_value());
  }
  const SlamResult result = slam.finish();
  EXPECT_FALSE(result.refusal.empty());
  EXPECT_TRUE(result.trajectory.empty());
}

TEST(Slam, GreyPicturesGiveTheSamePosesAsColouredOnes) {
  Slam coloured(scene().camera(), lockstep(0)), grey(scene().camera(), lockstep(0));
  for (int i = 0; i < 30; ++i) {
    cv::Mat picture;
    cv::cvtColor(pictures()[i], picture, cv::COLOR_BGR2GRAY);
    const auto a = coloured.process(pictures()[i], i / 30.0), b = grey.process(picture, i / 30.0);
    ASSERT_EQ(a.T_wc.has_value(), b.T_wc.has_value());
    if (a.T_wc) {
      EXPECT_EQ(a.T_wc->translation(), b.T_wc->translation());
    }
  }
}

}  // namespace
}  // namespace cairn
