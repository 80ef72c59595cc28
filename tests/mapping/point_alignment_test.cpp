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

// Its neighbours say ever better how a point's surface lies. The map's own wall faces the camera.
TEST(PointAlignment, AFacetThatLiesOtherwiseThanThoughtIsTurnedAndFoundAnewWherePicturesAreAtHand) {
  PaintedMap painted;
  const KeyframeId first = painted.add(SE3());
  align_points(painted.map, first);
  for (int i = 1; i <= 5; ++i) painted.add(beside(0.04 * i));
  const KeyframeId newest = painted.map.newest();
  MapPoint& point = painted.map.points()[painted.ids()[17]];
  point.patch = std::make_shared<PointPatch>(point.patch->turned({0.8, 0, 1}));
  painted.map.keyframes()[first].picture = nullptr;
  for (Observation& o : point.observations) o.patch = PatchState::kMissed;
  align_points(painted.map, newest);
  EXPECT_GT(std::abs(point.patch->normal().z()), 0.98);
  for (const Observation& o : point.observations) {
    EXPECT_EQ(o.patch, o.keyframe == first ? PatchState::kMissed : PatchState::kFound);
  }
}

TEST(PointAlignment, AFacetThatLiesAboutAsThoughtStays) {
  PaintedMap painted;
  align_points(painted.map, painted.add(SE3()));
  for (int i = 1; i <= 5; ++i) painted.add(beside(0.04 * i));
  MapPoint& point = painted.map.points()[painted.ids()[17]];
  const Eigen::Vector3d slightly(0.09, 0, 1);
  point.patch = std::make_shared<PointPatch>(point.patch->turned(slightly));
  const auto before = point.patch;
  align_points(painted.map, painted.map.newest());
  EXPECT_EQ(point.patch, before);
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
