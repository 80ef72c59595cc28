#pragma once

// Walls, floors and what stands before them, as detectors show them to the map.

#include <gtest/gtest.h>

#include <vector>

#include "cairn/mapping/plane_mapping.h"
#include "geometry/planes.h"
#include "map/flat_map.h"

namespace cairn::testing {

inline constexpr double kScale = 2;  // units of the map a metre of the detector

inline SeenPlane in_metres(SeenPlane seen) {
  seen.plane = seen.plane.scaled(1 / kScale);
  seen.centroid /= kScale;
  seen.sigma_offset /= kScale;
  for (Eigen::Vector3d& corner : seen.outline) corner /= kScale;
  return seen;
}

// Planes by corners (world), disturbed, with so many keypoints each, one after the other.
inline KeyframePerception perceive(const Map& map, KeyframeId id,
                                   const std::vector<std::vector<Eigen::Vector3d>>& planes,
                                   std::uint32_t keypoints, double angle_deg, double share) {
  const Keyframe& keyframe = map.keyframes()[id];
  KeyframePerception perception;
  perception.frame = keyframe.frame;
  perception.depth.assign(keyframe.frame->size(), 0);
  for (const auto& corners : planes) {
    SeenPlane seen = disturbed(seen_from(keyframe.T_wc, corners), angle_deg, share);
    seen.keypoints =
        indices(static_cast<std::uint32_t>(perception.planes.size()) * keypoints, keypoints);
    seen.inner = seen.keypoints;
    seen.sigma_angle = 0.1;
    seen.sigma_offset = 0.2;
    perception.planes.push_back(in_metres(seen));
  }
  return perception;
}

class MapPlanesOfPictures : public ::testing::Test {
 protected:
  // 36 points of a wall, 36 of the floor before it, 6 in front of the wall.
  MapPlanesOfPictures() {
    points = grid_on(wall_corners(), 6);
    const auto on_floor = grid_on(floor, 6);
    points.insert(points.end(), on_floor.begin(), on_floor.end());
    for (int i = 0; i < 6; ++i) points.emplace_back(0.2 * i - 0.5, 0.1 * i - 0.2, 3);
    map = map_of(points, few_poses(3));
  }
  // What became points of assumed depth.
  std::vector<PointId> show_picture(KeyframeId id, const KeyframePerception& seen) {
    const DepthScale scale = {kScale, kScale, 0.04, 0};
    std::vector<PointId> assumed = map_planes(map, id, seen, scale, options);
    EXPECT_EQ(broken_planes(map), "");
    return assumed;
  }
  void show(KeyframeId id, const std::vector<std::vector<Eigen::Vector3d>>& planes) {
    show_picture(id, perceive(map, id, planes, 36, 5, 0.04));
  }

  const std::vector<Eigen::Vector3d> floor = rectangle({-1, 1, 2.7}, {2, 0, 0}, {0, 0, 1.2});
  std::vector<Eigen::Vector3d> points;
  Map map{point_view()};
  PlaneMappingOptions options;
};

}  // namespace cairn::testing
