#include "cairn/features/matching.h"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "cairn/features/orb_extractor.h"
#include "textures.h"

namespace cairn {
namespace {

using ::testing::UnorderedElementsAreArray;

std::vector<Descriptor> random_descriptors(int count, std::mt19937_64& engine) {
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& descriptor : descriptors) {
    for (std::uint64_t& word : descriptor) word = engine();
  }
  return descriptors;
}

std::vector<std::uint32_t> in_window(const KeypointGrid& grid, const std::vector<Keypoint>& points,
                                     cv::Point2f center, float radius, int low, int high) {
  std::vector<std::uint32_t> found;
  grid.for_each(points, center, radius, low, high, [&](std::uint32_t i) { found.push_back(i); });
  return found;
}

TEST(KeypointGrid, FindsExactlyTheKeypointsOfTheWindowAndOctaves) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> place(-30, 700);
  std::uniform_int_distribution<int> octave(0, 7);
  std::vector<Keypoint> points(1000);
  for (Keypoint& point : points) {
    point.x = place(engine);
    point.y = place(engine);
    point.octave = static_cast<std::int8_t>(octave(engine));
  }
  KeypointGrid grid;
  grid.build(points);
  std::uniform_real_distribution<float> center_of(-200, 900), radius_of(0, 120);
  for (int trial = 0; trial < 300; ++trial) {
    const cv::Point2f center(center_of(engine), center_of(engine));
    const float radius = radius_of(engine);
    const int low = octave(engine), high = octave(engine);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (std::abs(points[i].x - center.x) <= radius &&
          std::abs(points[i].y - center.y) <= radius && points[i].octave >= low &&
          points[i].octave <= high) {
        expected.push_back(i);
      }
    }
    EXPECT_THAT(in_window(grid, points, center, radius, low, high),
                UnorderedElementsAreArray(expected));
  }
}

TEST(KeypointGrid, TakesNoKeypointsAndFarOnes) {
  KeypointGrid grid;
  EXPECT_TRUE(in_window(grid, {}, {10, 10}, 5, 0, 7).empty());
  grid.build({});
  EXPECT_TRUE(in_window(grid, {}, {10, 10}, 5, 0, 7).empty());
  const std::vector<Keypoint> points = {
      {.x = 1e7F, .y = -1e7F}, {.x = 3, .y = 4}, {.x = 3, .y = 4}};
  grid.build(points);
  EXPECT_THAT(in_window(grid, points, {3, 4}, 0, 0, 7), UnorderedElementsAreArray({1U, 2U}));
  EXPECT_TRUE(in_window(grid, points, {1e9F, 1e9F}, 1, 0, 7).empty());
}

TEST(BestMatch, IsTheNearestAndKnowsTheSecond) {
  std::mt19937_64 engine(2);
  auto descriptors = random_descriptors(100, engine);
  const Descriptor wanted = descriptors[40];
  descriptors[40][0] ^= 0b1;
  descriptors[70] = wanted;
  descriptors[70][3] ^= 0b111;
  const BestMatch best = best_match(wanted, descriptors);
  EXPECT_EQ(best.index, 40U);
  EXPECT_EQ(best.distance, 1);
  EXPECT_EQ(best.second_index, 70U);
  EXPECT_EQ(best.second_distance, 3);
  EXPECT_TRUE(best.accepted(50, 0.5));
  EXPECT_FALSE(best.accepted(50, 0.3));
  const std::vector<std::uint32_t> some = {3, 70, 9};
  EXPECT_EQ(best_match(wanted, descriptors, some).index, 70U);
  EXPECT_FALSE(best_match(wanted, descriptors, std::span<const std::uint32_t>{}).found());
}

TEST(RotationHistogram, KeepsWhatTurnsAsMostDo) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> any(0, kTurn);
  std::vector<Keypoint> first(200), second(200);
  std::vector<Match> matches;
  for (std::uint32_t i = 0; i < 200; ++i) {
    first[i].angle = any(engine);
    second[i].angle = i < 150 ? std::remainder(first[i].angle + 0.02F, kTurn) : any(engine);
    matches.push_back({i, i, 0});
  }
  filter_by_rotation(first, second, matches);
  EXPECT_GE(matches.size(), 150U);
  EXPECT_LE(matches.size(), 165U);
  EXPECT_EQ(matches[149].first, 149U);
  matches.clear();
  filter_by_rotation(first, second, matches);
  EXPECT_TRUE(matches.empty());
}

TEST(MatchMutual, MatchesATurnedPictureWhereItShould) {
  const cv::Size size(480, 480);
  const cv::Mat image = random_texture(size, 11);
  const cv::Point2f center(239.5F, 239.5F);
  const cv::Mat turn = cv::getRotationMatrix2D(center, 30, 1);
  cv::Mat turned;
  cv::warpAffine(image, turned, turn, size);
  OrbExtractor extractor({});
  Features first, second;
  extractor.extract(image, first);
  extractor.extract(turned, second);
  const auto matches = match_mutual(first, second);
  EXPECT_GT(matches.size(), 150U);
  int right = 0;
  for (const Match& match : matches) {
    const Keypoint& a = first.keypoints[match.first];
    const Keypoint& b = second.keypoints[match.second];
    const double x =
        turn.at<double>(0, 0) * a.x + turn.at<double>(0, 1) * a.y + turn.at<double>(0, 2);
    const double y =
        turn.at<double>(1, 0) * a.x + turn.at<double>(1, 1) * a.y + turn.at<double>(1, 2);
    right += std::hypot(x - b.x, y - b.y) < 3 * std::pow(1.2, a.octave);
  }
  EXPECT_GT(right, 0.95 * matches.size());
}

TEST(MatchMutual, GivesNothingForNothing) {
  EXPECT_TRUE(match_mutual({}, {}).empty());
  Features one;
  one.keypoints.resize(1);
  one.descriptors.resize(1);
  EXPECT_TRUE(match_mutual(one, {}).empty());
  EXPECT_EQ(match_mutual(one, one).size(), 1U);
}

}  // namespace
}  // namespace cairn
