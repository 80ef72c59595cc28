#include "cairn/tracking/projection_search.h"

#include <gtest/gtest.h>

namespace cairn {
namespace {

// Keypoints in a row, 20 pixels apart; descriptor i has i bits set.
Frame row_of_keypoints(int count) {
  Frame frame;
  for (int i = 0; i < count; ++i) {
    frame.features.keypoints.push_back({float(20 * i + 20), 50, 0, 1, 1});
    frame.features.descriptors.push_back({(std::uint64_t{1} << i) - 1, 0, 0, 0});
  }
  frame.grid.build(frame.features.keypoints);
  return frame;
}

ExpectedPoint expected(std::uint32_t index, float x, float radius, const Descriptor& descriptor) {
  return {index, {x, 50}, radius, 0, 2, &descriptor};
}

TEST(ProjectionSearch, TakesTheKeypointInReachThatLooksMostAlike) {
  const Frame frame = row_of_keypoints(5);
  const Descriptor looks = frame.features.descriptors[3];
  std::vector<std::uint32_t> taken(5, kNoPoint);
  const std::vector<ExpectedPoint> points = {expected(9, 60, 25, looks)};  // keypoints 1 to 3
  EXPECT_EQ(search_by_projection(frame, points, {}, taken), 1);
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{kNoPoint, kNoPoint, kNoPoint, 9, kNoPoint}));
}

TEST(ProjectionSearch, LeavesAloneWhatIsTakenOrOutOfReachOrOfAnotherOctave) {
  const Frame frame = row_of_keypoints(3);
  const Descriptor looks = frame.features.descriptors[1];
  std::vector<std::uint32_t> taken = {kNoPoint, 4, kNoPoint};
  ExpectedPoint far = expected(1, 200, 25, looks), fine = expected(2, 40, 5, looks);
  fine.max_octave = 0;
  EXPECT_EQ(
      search_by_projection(frame, std::vector{expected(0, 40, 5, looks), far, fine}, {}, taken), 0);
  EXPECT_EQ(taken[1], 4u);
}

TEST(ProjectionSearch, AKeypointThatTwoPointsWantGoesToTheOneThatLooksMoreAlike) {
  const Frame frame = row_of_keypoints(1);
  const Descriptor exact = frame.features.descriptors[0], other = {0b111, 0, 0, 0};
  for (const bool exact_first : {true, false}) {
    std::vector<ExpectedPoint> points = {expected(1, 20, 5, exact), expected(2, 20, 5, other)};
    if (!exact_first) std::swap(points[0], points[1]);
    std::vector<std::uint32_t> taken(1, kNoPoint);
    EXPECT_EQ(search_by_projection(frame, points, {}, taken), 1);
    EXPECT_EQ(taken[0], 1u);
  }
}

TEST(ProjectionSearch, RefusesWhatIsNotClearlyNearerThanTheSecond) {
  const Frame frame = row_of_keypoints(12);
  const Descriptor between = frame.features.descriptors[11], neither = {~0ULL, 0, 0, 0};
  std::vector<std::uint32_t> taken(12, kNoPoint);
  const std::vector<ExpectedPoint> points = {expected(0, 220, 30, neither)};
  EXPECT_EQ(search_by_projection(frame, points, {.max_distance = 60, .ratio = 0.9}, taken), 0);
  const std::vector<ExpectedPoint> clear = {expected(0, 220, 30, between)};
  EXPECT_EQ(search_by_projection(frame, clear, {.max_distance = 60, .ratio = 0.9}, taken), 1);
}

TEST(ProjectionSearch, RefusesWhatLooksTooDifferent) {
  const Frame frame = row_of_keypoints(1);
  const Descriptor stranger = {~0ULL, ~0ULL, 0, 0};
  std::vector<std::uint32_t> taken(1, kNoPoint);
  const std::vector<ExpectedPoint> points = {expected(0, 20, 5, stranger)};
  EXPECT_EQ(search_by_projection(frame, points, {.max_distance = 100}, taken), 0);
}

}  // namespace
}  // namespace cairn
