#include "cairn/system/mapping_schedule.h"

#include <gtest/gtest.h>

#include "map/links.h"
#include "mapping/drive.h"

namespace cairn {
namespace {

using testing::along;

constexpr int kInserted = 8;  // keyframes after the first two

class MappingScheduleTest : public ::testing::TestWithParam<Pace> {
 protected:
  MappingScheduleTest() {
    options.pace = GetParam();
    auto mapper = std::make_unique<Mapper>(testing::point_view(), options.mapping);
    EXPECT_TRUE(mapper->initialize(drive.initial(along(0), along(0.3))));
    schedule = std::make_unique<MappingSchedule>(std::move(mapper), options);
  }
  void insert(double s) {
    schedule->insert(drive.candidate(along(s), *schedule->view()), {});
    schedule->settle();
  }

  testing::PointWorld world{91};
  testing::Drive drive{world};
  Options options;
  std::unique_ptr<MappingSchedule> schedule;
};

TEST_P(MappingScheduleTest, MakesAMapOfAllKeyframesBeforeItStops) {
  for (int i = 0; i < kInserted; ++i) insert(0.5 + 0.2 * i);
  Mapper& mapper = schedule->stop();
  const Map& map = mapper.map();
  EXPECT_EQ(map.keyframes().size() + mapper.buried().size(), 2u + kInserted);
  EXPECT_EQ(testing::broken_links(map), "");
  EXPECT_LT(testing::errors_of(map, world).camera, 0.15);
  EXPECT_EQ(schedule->view()->version, mapper.view()->version) << "the last view is public";
  EXPECT_EQ(schedule->backlog(), 0);
}

// What a camera in trouble asks for: more keyframes than the mapper gets done.
TEST_P(MappingScheduleTest, AdjustsTheMapEveryThirdKeyframeHoweverManyWait) {
  constexpr int kMany = 12;
  for (int i = 0; i < kMany; ++i) insert(0.5 + 0.05 * i);
  EXPECT_GE(schedule->stop().times().adjustment.size(), kMany / 3u);
}

TEST_P(MappingScheduleTest, PublishesANewerViewAfterAKeyframe) {
  const auto before = schedule->view();
  insert(0.5);
  schedule->stop();
  EXPECT_GT(schedule->view()->version, before->version);
  EXPECT_NE(schedule->view()->reference, before->reference);
}

TEST_P(MappingScheduleTest, AnswersWhereALostFrameIs) {
  for (int i = 0; i < 3; ++i) insert(0.5 + 0.2 * i);
  EXPECT_FALSE(schedule->take_relocalization().has_value()) << "nobody has asked yet";
  const auto frame = world.show(along(0.55), 100);
  schedule->relocalize(frame, 1);
  std::optional<MappingSchedule::Answer> answer;
  while (!(answer = schedule->take_relocalization())) std::this_thread::yield();
  EXPECT_EQ(answer->frame, frame);
  ASSERT_TRUE(answer->found.has_value());
  EXPECT_GT(answer->found->inliers, 30);
  EXPECT_FALSE(schedule->take_relocalization().has_value()) << "an answer is given once";
  EXPECT_FALSE(schedule->relocalizing());
}

// It may have come back to where it was long ago: the newest keyframe does not see that place.
TEST_P(MappingScheduleTest, ShowsTheMapAroundACameraThatWasFoundUntilTheNextKeyframe) {
  for (int i = 0; i < kInserted; ++i) insert(0.5 + 0.2 * i);
  schedule->relocalize(world.show(along(0.1), 100), 1);
  std::optional<MappingSchedule::Answer> answer;
  while (!(answer = schedule->take_relocalization())) std::this_thread::yield();
  ASSERT_TRUE(answer->found.has_value());
  const KeyframeId found_by = answer->found->view->reference;
  const SE3 T_wc = schedule->view()->pose_of(found_by).value();
  EXPECT_LT((T_wc.translation() - answer->found->T_wc.translation()).norm(), 0.5);
  schedule->settle();
  EXPECT_EQ(schedule->view()->reference, found_by) << "an adjustment has looked away";
  insert(0.1);
  schedule->stop();
  EXPECT_NE(schedule->view()->reference, found_by);
}

TEST_P(MappingScheduleTest, SaysThatAForeignFrameIsNowhere) {
  testing::PointWorld elsewhere(92);
  schedule->relocalize(elsewhere.show(along(0), 100), 1);
  std::optional<MappingSchedule::Answer> answer;
  while (!(answer = schedule->take_relocalization())) std::this_thread::yield();
  EXPECT_FALSE(answer->found.has_value());
}

TEST_P(MappingScheduleTest, StopsWithoutAnyWorkAndMayBeStoppedTwice) {
  Mapper& mapper = schedule->stop();
  EXPECT_EQ(mapper.map().keyframes().size(), 2u);
  EXPECT_EQ(&schedule->stop(), &mapper);
}

TEST_P(MappingScheduleTest, MayBeDestroyedWithWorkLeft) {
  for (int i = 0; i < 3; ++i) insert(0.5 + 0.2 * i);
  schedule->relocalize(world.show(along(0.55), 100), 1);
  schedule.reset();
}

INSTANTIATE_TEST_SUITE_P(BothPaces, MappingScheduleTest,
                         ::testing::Values(Pace::kLockstep, Pace::kRealtime), [](const auto& info) {
                           return info.param == Pace::kLockstep ? "Lockstep" : "Realtime";
                         });

}  // namespace
}  // namespace cairn
