#pragma once

// Small maps made by hand: keyframes that all see the same points, planes as keyframes see them,
// and what is wrong with the planes of a map, in words.

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cairn/map/map.h"
#include "geometry/scene.h"
#include "map/point_world.h"

namespace cairn::testing {

/// Corners of a parallelogram, in order.
inline std::vector<Eigen::Vector3d> rectangle(const Eigen::Vector3d& corner,
                                              const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return {corner, corner + u, corner + u + v, corner + v};
}

/// count × count points over a parallelogram, its edges among them; along v first.
inline std::vector<Eigen::Vector3d> grid_on(const std::vector<Eigen::Vector3d>& corners,
                                            int count) {
  const Eigen::Vector3d u = (corners[1] - corners[0]) / (count - 1);
  const Eigen::Vector3d v = (corners[3] - corners[0]) / (count - 1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < count; ++k) points.push_back(corners[0] + double(i) * u + double(k) * v);
  }
  return points;
}

/// A piece of the wall z = 4, which all of few_poses() see.
inline std::vector<Eigen::Vector3d> wall_corners() {
  return rectangle({-1.5, -1, 4}, {3, 0, 0}, {0, 2, 0});
}

/// A short walk to the right, turning to the left.
inline std::vector<SE3> few_poses(int count) {
  std::vector<SE3> poses;
  poses.reserve(count);
  for (int i = 0; i < count; ++i) {
    poses.emplace_back(so3_exp(Eigen::Vector3d(0.01 * i, -0.05 * i, 0)),
                       Eigen::Vector3d(0.3 * i, 0.02 * i, -0.05 * i));
  }
  return poses;
}

/// A frame with keypoints at these pixels, all of octave 0.
inline std::shared_ptr<const Frame> frame_at(const std::vector<Eigen::Vector2d>& pixels,
                                             double timestamp) {
  auto frame = std::make_shared<Frame>();
  frame->timestamp = timestamp;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Keypoint keypoint;
    keypoint.x = static_cast<float>(pixels[i].x());
    keypoint.y = static_cast<float>(pixels[i].y());
    frame->features.keypoints.push_back(keypoint);
    frame->features.descriptors.push_back(Descriptor{std::uint64_t{i}, 0, 0, 0});
  }
  frame->grid.build(frame->features.keypoints);
  return frame;
}

/// Keyframes at these poses; keypoint i of each sees point i, up to `noise` pixels.
inline Map map_of(const std::vector<Eigen::Vector3d>& points, std::span<const SE3> poses,
                  double noise = 0, std::uint64_t seed = 1) {
  Random random(seed);
  Map map(point_view());
  std::vector<KeyframeId> keyframes;
  for (const SE3& T_wc : poses) {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& x : points) {
      const double du = random.gaussian(), dv = random.gaussian();
      pixels.push_back(kCamera.project(T_wc.inverse() * x) + noise * Eigen::Vector2d(du, dv));
    }
    keyframes.push_back(map.add_keyframe(frame_at(pixels, double(keyframes.size())), T_wc));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointId id = map.add_point(points[i]);
    for (const KeyframeId k : keyframes) {
      map.add_observation(id, k, static_cast<std::uint32_t>(i));
    }
    map.update_descriptor(id);
    map.update_geometry(id);
  }
  return map;
}

/// In order of slots: of a map_of() in order of the points it was made of.
inline std::vector<PointId> points_of(const Map& map) {
  std::vector<PointId> ids;
  map.points().for_each([&](PointId id, const MapPoint&) { ids.push_back(id); });
  return ids;
}

inline std::vector<PlaneId> planes_of(const Map& map) {
  std::vector<PlaneId> ids;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark&) { ids.push_back(id); });
  return ids;
}

/// first, first + 1, ... of that number.
inline std::vector<std::uint32_t> indices(std::uint32_t first, std::uint32_t number) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < number; ++i) result.push_back(first + i);
  return result;
}

/// The plane patch with these corners (world) as a keyframe at T_wc sees it, without error.
inline SeenPlane seen_from(const SE3& T_wc, const std::vector<Eigen::Vector3d>& corners,
                           const std::string& label = "wall") {
  SeenPlane seen;
  const SE3 T_cw = T_wc.inverse();
  for (const Eigen::Vector3d& corner : corners) {
    seen.outline.push_back(T_cw * corner);
    seen.centroid += seen.outline.back() / double(corners.size());
  }
  const Eigen::Vector3d u = seen.outline[1] - seen.outline[0];
  const Eigen::Vector3d v = seen.outline[2] - seen.outline[0];
  seen.plane = Plane::through(seen.centroid, u.cross(v).normalized()).facing_origin();
  seen.label = label;
  return seen;
}

/// Turned about an axis in the plane through its centroid, and farther away by a share.
inline SeenPlane disturbed(const SeenPlane& seen, double angle_deg, double share) {
  const Eigen::Vector3d n = seen.plane.normal();
  const Eigen::Vector3d axis = tangent_axes(n) * Eigen::Vector2d(0.6, 0.8);
  const Eigen::Quaterniond turn = so3_exp(Eigen::Vector3d(axis * (angle_deg * M_PI / 180)));
  SeenPlane result = seen;
  result.centroid = (1 + share) * seen.centroid;
  result.plane = Plane::through(result.centroid, turn * n);
  for (std::size_t i = 0; i < seen.outline.size(); ++i) {
    const Eigen::Vector3d arm = seen.outline[i] - seen.centroid;
    result.outline[i] = result.centroid + turn * arm;
  }
  return result;
}

/// What is wrong with the planes of a map and their links, in words; empty if nothing is.
inline std::string broken_planes(const Map& map) {
  std::string wrong;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    const std::string name = "plane " + std::to_string(id.slot);
    if (!map.keyframes().contains(landmark.reference)) wrong += name + " has no reference\n";
    for (const PointId p : landmark.points) {
      if (!map.points().contains(p)) {
        wrong += name + " has a point that is gone\n";
      } else if (map.points()[p].plane != id) {
        wrong += name + " has a point that does not know it\n";
      }
      if (std::count(landmark.points.begin(), landmark.points.end(), p) > 1) {
        wrong += name + " has a point twice\n";
      }
    }
    for (const PlaneObservation& o : landmark.observations) {
      if (!map.keyframes().contains(o.keyframe)) wrong += name + ": its observer is gone\n";
      const auto same = [&](const PlaneObservation& other) { return other.keyframe == o.keyframe; };
      if (std::count_if(landmark.observations.begin(), landmark.observations.end(), same) > 1) {
        wrong += name + " is observed twice by a keyframe\n";
      }
    }
  });
  map.points().for_each([&](PointId id, const MapPoint& point) {
    if (!point.plane.valid()) return;
    const PlaneLandmark* landmark = map.planes().find(point.plane);
    if (landmark == nullptr) {
      wrong += "a point lies on a plane that is gone\n";
    } else if (std::count(landmark->points.begin(), landmark->points.end(), id) != 1) {
      wrong += "a point lies on a plane that does not know it\n";
    }
  });
  for (const RelatedPlanes& r : map.relations()) {
    if (!map.planes().contains(r.a) || !map.planes().contains(r.b)) {
      wrong += "a relation is of a plane that is gone\n";
    }
  }
  return wrong;
}

}  // namespace cairn::testing
