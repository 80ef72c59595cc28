#include "cairn/tracking/relocalizer.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::PointWorld;

class RelocalizerTest : public ::testing::Test {
 protected:
  RelocalizerTest() {
    std::vector<SE3> poses;
    for (int i = 0; i < 6; ++i) poses.push_back(along(0.35 * i));
    map = testing::true_map(world, poses);
    candidates = testing::keyframes_of(map);
  }

  PointWorld world{51};
  Map map{testing::point_view()};
  std::vector<KeyframeId> candidates;
};

TEST_F(RelocalizerTest, FindsAFrameFromNothingButItsFeatures) {
  for (const double s : {0.1, 0.5, 1.0, 1.6}) {
    const auto frame = world.show(along(s), 100 + s);
    const auto found = relocalize(*frame, map, candidates, {}, 1);
    ASSERT_TRUE(found.has_value()) << s;
    EXPECT_LT((found->T_wc.translation() - along(s).translation()).norm(), 0.03);
    EXPECT_LT(testing::rotation_error_deg(found->T_wc, along(s)), 0.4);
    ASSERT_EQ(found->points.size(), frame->size());
    int right = 0, all = 0;
    for (std::size_t i = 0; i < frame->size(); ++i) {
      if (!found->points[i].valid()) continue;
      ++all;
      right += world.point_of(map, map.points()[found->points[i]]) == world.point_of(*frame, i);
    }
    EXPECT_EQ(all, found->inliers);
    EXPECT_GT(right, 0.97 * all);
    ASSERT_NE(found->view, nullptr);
    EXPECT_TRUE(found->view->pose_of(found->view->reference).has_value());
  }
}

TEST_F(RelocalizerTest, RefusesAFrameOfAnotherWorld) {
  PointWorld elsewhere(52);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto frame = elsewhere.show(along(0.3 * double(seed)), 1);
    EXPECT_FALSE(relocalize(*frame, map, candidates, {}, seed).has_value());
  }
}

// As a patch of a wallpaper's pattern would agree with the same patch elsewhere.
TEST_F(RelocalizerTest, RefusesAPoseThatShowsOnlyAFewOfThePointsInSight) {
  PointWorld patch(51, {.count = 105, .noise = 0.3, .bit_flips = 0});  // the first of all points
  TrackingOptions options;
  options.min_inliers = 20;
  const auto frame = patch.show(along(1.0), 100);
  EXPECT_FALSE(relocalize(*frame, map, candidates, options, 1).has_value());
  PointWorld more(51, {.count = 750, .noise = 0.3, .bit_flips = 0});
  EXPECT_TRUE(relocalize(*more.show(along(1.0), 100), map, candidates, options, 1).has_value());
}

TEST_F(RelocalizerTest, RefusesAFrameWithoutFeatures) {
  PointWorld dark(53, {.count = 0, .clutter = 0});
  EXPECT_FALSE(relocalize(*dark.show(SE3(), 1), map, candidates, {}, 0).has_value());
}

TEST_F(RelocalizerTest, PassesOverCandidatesThatAreGone) {
  const auto frame = world.show(along(1.0), 100);
  map.erase_keyframe(candidates[2]);
  const auto found = relocalize(*frame, map, {{candidates[2], KeyframeId(), candidates[3]}}, {}, 1);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->view->reference, candidates[3]);
  EXPECT_FALSE(relocalize(*frame, map, {}, {}, 1).has_value());
}

TEST_F(RelocalizerTest, OfAllCandidatesTheOneThatExplainsMostIsTheAnswer) {
  const auto frame = world.show(along(1.2), 100);
  const auto found = relocalize(*frame, map, candidates, {}, 1);
  const std::vector<KeyframeId> backwards(candidates.rbegin(), candidates.rend());
  const auto again = relocalize(*frame, map, backwards, {}, 1);
  ASSERT_TRUE(found && again);
  for (const KeyframeId id : candidates) {
    const auto alone = relocalize(*frame, map, {{id}}, {}, 1);
    EXPECT_LE(alone ? alone->inliers : 0, found->inliers);
  }
  EXPECT_EQ(again->inliers, found->inliers);
}

TEST_F(RelocalizerTest, SameSeedSameAnswer) {
  const auto frame = world.show(along(0.8), 100);
  const auto first = relocalize(*frame, map, candidates, {}, 9);
  const auto second = relocalize(*frame, map, candidates, {}, 9);
  ASSERT_TRUE(first && second);
  EXPECT_EQ((first->T_wc.matrix() - second->T_wc.matrix()).norm(), 0);
  EXPECT_EQ(first->points, second->points);
}

}  // namespace
}  // namespace cairn
