#include "cairn/mapping/point_alignment.h"

#include <gtest/gtest.h>

#include "mapping/painted_map.h"

namespace cairn {
namespace {

using testing::beside;
using testing::PaintedMap;

TEST(PointAlignment, AllKeyframesComeToSeeAPointWhereItLooksAlike) {
  PaintedMap painted;
  const KeyframeId first = painted.add(SE3());
  const KeyframeId second = painted.add(beside(0.1));
  EXPECT_GT(painted.worst(second, first), 0.5);
  align_points(painted.map, second);  // the newest is where new points are cut
  EXPECT_EQ(painted.aligned(second), int(painted.size()));
  EXPECT_GT(painted.aligned(first), 0.9 * painted.size());
  EXPECT_LT(painted.worst(second, first), 0.2);
  const KeyframeId third = painted.add(beside(-0.15));
  align_points(painted.map, third);
  EXPECT_GT(painted.aligned(third), 0.9 * painted.size());
  EXPECT_LT(painted.worst(second, third), 0.2);
}

TEST(PointAlignment, FramesThatATrackerMayHoldStayAsTheyAre) {
  PaintedMap painted;
  const KeyframeId first = painted.add(SE3());
  const KeyframeId second = painted.add(beside(0.1));
  const std::shared_ptr<const Frame> held = painted.map.keyframes()[first].frame;
  const std::vector<Keypoint> before = held->features.keypoints;
  align_points(painted.map, second);
  EXPECT_EQ(held->features.keypoints, before);
  EXPECT_NE(painted.map.keyframes()[first].frame, held);
}

TEST(PointAlignment, WithoutPicturesNothingHappens) {
  PaintedMap painted;
  const KeyframeId id = painted.add(SE3());
  painted.map.keyframes()[id].picture = nullptr;
  align_points(painted.map, id);
  EXPECT_EQ(painted.aligned(id), 0);
}

}  // namespace
}  // namespace cairn
