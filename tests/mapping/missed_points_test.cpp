#include "cairn/mapping/missed_points.h"

#include <gtest/gtest.h>

#include "cairn/mapping/point_alignment.h"
#include "mapping/painted_map.h"

namespace cairn {
namespace {

using testing::beside;
using testing::PaintedMap;

constexpr std::size_t kFound = 10;  // corners, in the pictures that miss some

// Three keyframes see all points; the first is `first`.
class MissedPoints : public ::testing::Test {
 protected:
  MissedPoints() {
    align_points(painted.map, first);
    for (const double x : {0.05, 0.1}) align_points(painted.map, painted.add(beside(x)));
  }

  const Keyframe& keyframe(KeyframeId id) { return painted.map.keyframes()[id]; }

  PaintedMap painted;
  KeyframeId first = painted.add(SE3());
};

TEST_F(MissedPoints, AreFoundWherePicturesLookAsTheyDo) {
  const KeyframeId id = painted.add(beside(0.15), kFound);
  align_points(painted.map, id);
  EXPECT_EQ(find_missed_points(painted.map, id), int(painted.size() - kFound));
  EXPECT_EQ(painted.aligned(id), int(painted.size()));
  EXPECT_LT(painted.worst(first, id), 0.2);
  EXPECT_EQ(keyframe(id).frame->corners(), kFound);
  EXPECT_EQ(keyframe(id).points.size(), keyframe(id).frame->size());
  EXPECT_EQ(find_missed_points(painted.map, id), 0);  // none is left
}

TEST_F(MissedPoints, TakeTheCornerThatIsThere) {
  const KeyframeId id = painted.add(beside(0.15));
  const PointId missed = painted.ids()[7];
  painted.map.erase_observation(missed, id);
  EXPECT_EQ(find_missed_points(painted.map, id), 1);
  EXPECT_EQ(painted.map.keypoint_of(missed, id), 7);
  EXPECT_EQ(keyframe(id).frame->added, 0U);
}

TEST_F(MissedPoints, AreNotFoundWhereSomethingElseIsInSight) {
  const KeyframeId id = painted.add(beside(0.15), kFound);
  painted.map.keyframes()[id].picture = std::make_shared<Picture>(
      painted.wall.show(SE3(so3_exp({0, 0, 0.8}), Eigen::Vector3d(0.5, 0.4, 0.3))));
  EXPECT_LT(find_missed_points(painted.map, id), 0.1 * painted.size());
}

TEST_F(MissedPoints, AreNotLookedForWithoutAPicture) {
  const KeyframeId id = painted.add(beside(0.15), kFound);
  painted.map.keyframes()[id].picture = nullptr;
  EXPECT_EQ(find_missed_points(painted.map, id), 0);
}

TEST_F(MissedPoints, LeaveFramesThatATrackerMayHoldAsTheyAre) {
  const KeyframeId id = painted.add(beside(0.15), kFound);
  const std::shared_ptr<const Frame> held = keyframe(id).frame;
  find_missed_points(painted.map, id);
  EXPECT_EQ(held->size(), kFound);
}

TEST_F(MissedPoints, AreKeptWhereAnInstantShutterWouldHaveSeenThem) {
  const KeyframeId id = painted.add(beside(0.15), kFound);
  auto rolling = std::make_shared<Frame>(*keyframe(id).frame);
  rolling->rows.assign(kFound, 128);
  Vector6d velocity = Vector6d::Zero();
  velocity[1] = 0.2;  // up to half a pixel along each axis in half of the readout
  unroll(*rolling, painted.wall.pinhole(), std::vector<double>(kFound, 2.0), 0.02, velocity);
  painted.map.keyframes()[id].frame = rolling;
  ASSERT_GT(find_missed_points(painted.map, id), 0.9 * (painted.size() - kFound));
  const Frame& frame = *keyframe(id).frame;
  double farthest = 0;
  for (std::size_t i = kFound; i < frame.size(); ++i) {
    const Eigen::Vector2d sighted = frame.sighted_pixel(i);
    const double z =
        (keyframe(id).T_wc.inverse() * painted.map.points()[keyframe(id).points[i]].position).z();
    const Eigen::Vector2d at_once =
        seen_at_once(painted.wall.pinhole(), sighted, z, frame.moment(i), frame.readout * velocity);
    EXPECT_LT((frame.pixel(i) - at_once).norm(), 0.01);
    farthest = std::max(farthest, (frame.pixel(i) - sighted).norm());
  }
  EXPECT_GT(farthest, 0.1);
}

// Points that become known while it is among the newest thirty.
TEST(LookingBack, FindsInOldPicturesWhatWasNotKnownThenAndLetsThemGo) {
  PaintedMap painted;
  const KeyframeId old = painted.add(SE3(), kFound);
  const auto keyframe = [&]() -> Keyframe& { return painted.map.keyframes()[old]; };
  keyframe().depth.assign(kFound, 1);
  std::vector<KeyframeId> newer;
  for (int i = 1; i <= 30; ++i) {
    look_back(painted.map);
    EXPECT_TRUE(keyframe().picture);
    newer.push_back(painted.add(beside(0.003 * i)));
    align_points(painted.map, newer.back());
  }
  EXPECT_EQ(painted.aligned(old), int(kFound));
  look_back(painted.map);
  EXPECT_EQ(painted.aligned(old), int(painted.size()));
  EXPECT_EQ(keyframe().depth.size(), keyframe().points.size());
  EXPECT_FALSE(keyframe().picture);
  for (const KeyframeId id : newer) EXPECT_TRUE(painted.map.keyframes()[id].picture);
}

}  // namespace
}  // namespace cairn
