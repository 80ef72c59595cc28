#include "cairn/mapping/point_alignment.h"

#include <gtest/gtest.h>

#include <random>

#include "map/painted_wall.h"

namespace cairn {
namespace {

using testing::PaintedWall;

// A wall with points that all keyframes see, at corners that are off by half a pixel or so.
class PaintedMap {
 public:
  PaintedMap() : map(View(wall.camera(), 4, 1.2, 1)) {
    for (double x = -0.6; x < 0.65; x += 0.2) {
      for (double y = -0.4; y < 0.45; y += 0.2) points_.emplace_back(x, y, PaintedWall::kZ);
    }
  }

  KeyframeId add(const SE3& T_wc) {
    auto frame = std::make_shared<Frame>();
    frame->timestamp = static_cast<double>(map.keyframes().size());
    std::uniform_real_distribution<float> off(-0.6F, 0.6F);
    for (const Eigen::Vector3d& point : points_) {
      const Eigen::Vector2d pixel = wall.pixel(T_wc, point);
      frame->features.keypoints.push_back({static_cast<float>(pixel.x()) + off(engine_),
                                           static_cast<float>(pixel.y()) + off(engine_)});
      frame->features.descriptors.emplace_back();
    }
    frame->grid.build(frame->features.keypoints);
    const KeyframeId id = map.add_keyframe(frame, T_wc);
    map.keyframes()[id].picture = std::make_shared<Picture>(wall.show(T_wc));
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (ids_.size() == i) ids_.push_back(map.add_point(points_[i]));
      map.add_observation(ids_[i], id, i);
    }
    return id;
  }

  // Of the distances between where a point is in one keyframe and where it should be, as the patch
  // says that is centred on its corner in the first.
  double worst(KeyframeId first, KeyframeId id) {
    double worst = 0;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d ray = wall.pinhole().unproject(map.keyframes()[first].frame->pixel(i));
      const SE3& T_wc = map.keyframes()[first].T_wc;
      const Eigen::Vector3d direction = T_wc.matrix3() * ray;
      const double t = (PaintedWall::kZ - T_wc.translation().z()) / direction.z();
      const Eigen::Vector3d X = T_wc.translation() + t * direction;
      const Keyframe& k = map.keyframes()[id];
      worst = std::max(worst, (wall.pixel(k.T_wc, X) - k.frame->pixel(i)).norm());
    }
    return worst;
  }

  int aligned(KeyframeId id) {
    int count = 0;
    for (const PointId p : ids_) {
      for (const Observation& o : map.points()[p].observations) {
        count += o.keyframe == id && o.aligned();
      }
    }
    return count;
  }

  std::size_t size() const { return points_.size(); }

  PaintedWall wall;
  Map map;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<PointId> ids_;
  std::mt19937 engine_{7};
};

SE3 beside(double x) {
  return SE3(so3_exp({0.01, 0.02 * x, 0.1 * x}), Eigen::Vector3d(x, 0.03, 0.1 * x));
}

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

TEST(PointAlignment, KeepsThePicturesOfTheNewestKeyframesOnly) {
  PaintedMap painted;
  std::vector<KeyframeId> ids;
  for (int i = 0; i < 35; ++i) {
    ids.push_back(painted.add(beside(0.003 * i)));
    align_points(painted.map, ids.back());
  }
  EXPECT_FALSE(painted.map.keyframes()[ids.front()].picture);
  EXPECT_TRUE(painted.map.keyframes()[ids.back()].picture);
  int kept = 0;
  for (const KeyframeId id : ids) kept += painted.map.keyframes()[id].picture != nullptr;
  EXPECT_EQ(kept, 30);
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
