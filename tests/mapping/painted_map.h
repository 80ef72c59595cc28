#pragma once

// A map of a painted wall, whose keyframes have pictures of it.

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "cairn/map/map.h"
#include "map/painted_wall.h"

namespace cairn::testing {

// A wall with points that all keyframes see, at corners that are off by half a pixel or so.
class PaintedMap {
 public:
  PaintedMap() : map(View(wall.camera(), 4, 1.2, 1)) {
    for (int x = -3; x <= 3; ++x) {
      for (int y = -2; y <= 2; ++y) points_.emplace_back(0.2 * x, 0.2 * y, PaintedWall::kZ);
    }
  }

  /// `corners`: the detector finds those of so many points.
  KeyframeId add(const SE3& T_wc, std::size_t corners = 1000) {
    auto frame = std::make_shared<Frame>();
    frame->timestamp = static_cast<double>(map.keyframes().size());
    corners = std::min(corners, points_.size());
    std::uniform_real_distribution<float> off(-0.6F, 0.6F);
    for (std::size_t i = 0; i < corners; ++i) {
      const Eigen::Vector2d pixel = wall.pixel(T_wc, points_[i]);
      frame->features.keypoints.push_back({static_cast<float>(pixel.x()) + off(engine_),
                                           static_cast<float>(pixel.y()) + off(engine_)});
      frame->features.descriptors.emplace_back();
    }
    frame->grid.build(frame->features.keypoints);
    const KeyframeId id = map.add_keyframe(frame, T_wc);
    map.keyframes()[id].picture = std::make_shared<Picture>(wall.show(T_wc));
    for (std::uint32_t i = 0; i < corners; ++i) {
      if (ids_.size() == i) ids_.push_back(map.add_point(points_[i]));
      map.add_observation(ids_[i], id, i);
      map.update_geometry(ids_[i]);
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
  const std::vector<PointId>& ids() const { return ids_; }

  PaintedWall wall;
  Map map;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<PointId> ids_;
  std::mt19937 engine_{7};
};

inline SE3 beside(double x) {
  return SE3(so3_exp({0.01, 0.02 * x, 0.1 * x}), Eigen::Vector3d(x, 0.03, 0.1 * x));
}

}  // namespace cairn::testing
