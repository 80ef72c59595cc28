#include "cairn/mapping/point_fusion.h"

#include <algorithm>
#include <span>

#include "cairn/map/neighbourhood.h"
#include "cairn/map/seen_points.h"
#include "cairn/map/visibility.h"

namespace cairn {
namespace {

constexpr int kMaxDistance = 50;       // Hamming
constexpr double kGate = 5.991;        // χ², 2 degrees of freedom, 95 %
constexpr double kAstray = 4 * kGate;  // of what saw a point, should it be elsewhere
constexpr std::size_t kSecondNeighbours = 5;

// The keypoint of the keyframe that shows the point best, or -1.
int find_keypoint(const View& view, const Frame& frame, const MapPoint& point, const Visibility& v,
                  double radius) {
  BestMatch best;
  frame.for_each_near(v.pixel.cast<float>(), static_cast<float>(radius * view.scale(v.octave)),
                      v.octave - 1, v.octave + 1, [&](std::uint32_t i) {
                        const double sigma = view.sigma(frame.octave(i));
                        if ((frame.pixel(i) - v.pixel).squaredNorm() > kGate * sigma * sigma)
                          return;
                        best.offer(i, hamming(point.descriptor, frame.features.descriptors[i]));
                      });
  return best.distance <= kMaxDistance ? static_cast<int>(best.index) : -1;
}

// Those of a point's observations that could not be of one at another place.
std::vector<Observation> astray(const Map& map, PointId id, const Eigen::Vector3d& position) {
  std::vector<Observation> result;
  for (const Observation& o : map.points()[id].observations) {
    const double sigma = map.view().sigma(map.keyframes()[o.keyframe].frame->octave(o.keypoint));
    const Eigen::Vector2d error = map.reprojection_error(o.keyframe, o.keypoint, position);
    if (!(error.squaredNorm() < kAstray * sigma * sigma)) result.push_back(o);
  }
  return result;
}

// Two points that look alike and meet at one keypoint are one if the rest of what saw them says so,
// too: on patterns that repeat, neighbours meet. Returns whether they were.
bool merge_if_one(Map& map, PointId from, PointId into) {
  const MapPoint& a = map.points()[from];
  const MapPoint& b = map.points()[into];
  const bool elsewhere = b.assumed && !a.assumed;  // where the one is that was measured
  const PointId moved = elsewhere ? into : from;
  const std::vector<Observation> wrong = astray(map, moved, elsewhere ? a.position : b.position);
  if (2 * wrong.size() > map.points()[moved].observations.size()) return false;
  map.merge_points(from, into);
  for (const Observation& o : wrong) {
    if (map.keypoint_of(into, o.keyframe) == static_cast<int>(o.keypoint)) {
      map.erase_observation(into, o.keyframe);
    }
  }
  map.update_geometry(into);
  return true;
}

// In order of its keypoints.
std::vector<PointId> points_of(const Map& map, KeyframeId id) {
  std::vector<PointId> points = map.keyframes()[id].points;
  std::erase_if(points, [](PointId p) { return !p.valid(); });
  return points;
}

}  // namespace

int fuse_into(Map& map, KeyframeId id, std::span<const PointId> points, double radius) {
  int fused = 0;
  const Keyframe& keyframe = map.keyframes()[id];
  const SE3 T_cw = keyframe.T_wc.inverse();
  for (const PointId p : points) {
    if (!map.points().contains(p) || map.keypoint_of(p, id) >= 0) continue;
    const MapPoint& point = map.points()[p];
    const Visibility v = predict_visibility(map.view(), T_cw, keyframe.T_wc.translation(),
                                            point.position, point.normal, point.base_distance);
    if (!v.visible) continue;
    const int keypoint = find_keypoint(map.view(), *keyframe.frame, point, v, radius);
    if (keypoint < 0) continue;
    const PointId other = keyframe.points[keypoint];
    if (!other.valid()) {
      map.add_observation(p, id, static_cast<std::uint32_t>(keypoint));
      map.update_descriptor(p);
      ++fused;
    } else {
      const bool seen_more = map.points()[other].observations.size() > point.observations.size();
      fused += seen_more ? merge_if_one(map, p, other) : merge_if_one(map, other, p);
    }
  }
  return fused;
}

int fuse_neighbourhood(Map& map, KeyframeId id, int neighbours) {
  const auto around =
      neighbourhood(map, id, {10, static_cast<std::size_t>(neighbours)}, {15, kSecondNeighbours});
  const auto targets = std::span(around).subspan(1);  // but for the keyframe itself
  int fused = 0;
  for (const KeyframeId target : targets) fused += fuse_into(map, target, points_of(map, id), 3);
  fused += fuse_into(map, id, points_seen_from(map, targets), 3);
  for (const PointId p : points_of(map, id)) {
    map.update_descriptor(p);
    map.update_geometry(p);
  }
  return fused;
}

int fuse_everywhere(Map& map) {
  std::vector<KeyframeId> keyframes;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { keyframes.push_back(id); });
  int fused = 0;
  for (const KeyframeId id : keyframes) {
    std::vector<PointId> points;
    map.points().for_each([&](PointId p, const MapPoint&) { points.push_back(p); });
    fused += fuse_into(map, id, points, 3);
  }
  map.points().for_each([&](PointId p, const MapPoint&) { map.update_geometry(p); });
  return fused;
}

}  // namespace cairn
