#include "cairn/association/plane_association.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

// How far a point, projected into the polygon's plane, is outside of a convex polygon whose corners
// run counter-clockwise seen from where `normal` points; 0 inside.
double distance_outside(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& point) {
  double outside = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double length = edge.norm();
    if (length <= 0) continue;
    const Eigen::Vector3d outward = edge.cross(normal) / length;
    outside = std::max(outside, outward.dot(point - polygon[i]));
  }
  return outside;
}

// Does a corner of the first polygon, or its middle, lie in the second, or nearly?
bool touch(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b,
           const Eigen::Vector3d& normal_b, double margin) {
  if (a.empty() || b.empty()) return false;
  if (distance_outside(b, normal_b, middle_of(a)) <= margin) return true;
  return std::any_of(a.begin(), a.end(), [&](const Eigen::Vector3d& corner) {
    return distance_outside(b, normal_b, corner) <= margin;
  });
}

class Candidates {
 public:
  Candidates(const Map& map, KeyframeId keyframe, const PlaneAssociationOptions& options)
      : map_(map), keyframe_(map.keyframes()[keyframe]), options_(options) {
    const SE3 T_kw = keyframe_.T_wc.inverse();
    map.planes().for_each([&](PlaneId id, const PlaneLandmark&) {
      Known known{id, map.plane_in_world(id).transformed(T_kw), map.outline_in_world(id)};
      for (Eigen::Vector3d& corner : known.outline) corner = T_kw * corner;
      known_.push_back(std::move(known));
    });
  }

  PlaneDecision decide(const SeenPlane& seen) const {
    std::map<PlaneId, int> shared;
    for (const std::uint32_t keypoint : seen.keypoints) {
      const PointId point = keyframe_.points[keypoint];
      if (!point.valid()) continue;
      const PlaneId plane = map_.points()[point].plane;
      if (plane.valid()) ++shared[plane];
    }
    const auto most =
        std::max_element(shared.begin(), shared.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const int count = most == shared.end() ? 0 : most->second;
    if (count >= options_.th_high) {
      const auto known = std::find_if(known_.begin(), known_.end(),
                                      [&](const Known& k) { return k.id == most->first; });
      if (agrees(seen, known->plane)) return {PlaneDecision::Kind::kKnown, most->first};
    }
    // Few keypoints, or those of a surface in front of this one: where it lies decides.
    const Known* nearest = nullptr;
    double least = 1;
    for (const Known& known : known_) {
      const double off = disagreement(seen, known.plane);
      const double margin = options_.max_offset * seen.centroid.norm();
      if (off > least) continue;
      const bool together = touch(seen.outline, known.outline, known.plane.normal(), margin) ||
                            touch(known.outline, convex_outline(seen.plane, seen.outline),
                                  seen.plane.normal(), margin);
      if (!together) continue;
      nearest = &known;
      least = off;
    }
    if (nearest != nullptr) return {PlaneDecision::Kind::kKnown, nearest->id};
    return {count < options_.th_low ? PlaneDecision::Kind::kNew : PlaneDecision::Kind::kUnclear,
            {}};
  }

 private:
  struct Known {
    PlaneId id;
    Plane plane;                           // in the keyframe's frame
    std::vector<Eigen::Vector3d> outline;  // in the keyframe's frame
  };

  // 1 where the normals or the offsets are as far apart as is allowed.
  double disagreement(const SeenPlane& seen, const Plane& plane) const {
    const double angle = angle_between(seen.plane, plane) / (options_.max_angle_deg * kRadians);
    const double offset = std::abs(plane.signed_distance(seen.centroid)) /
                          (options_.max_offset * seen.centroid.norm());
    return std::max(angle, offset);
  }
  bool agrees(const SeenPlane& seen, const Plane& plane) const {
    return disagreement(seen, plane) <= 1;
  }

  const Map& map_;
  const Keyframe& keyframe_;
  PlaneAssociationOptions options_;
  std::vector<Known> known_;
};

}  // namespace

std::vector<PlaneDecision> associate_planes(const Map& map, KeyframeId keyframe,
                                            std::span<const SeenPlane> seen,
                                            const PlaneAssociationOptions& options) {
  const Candidates candidates(map, keyframe, options);
  std::vector<PlaneDecision> decisions;
  decisions.reserve(seen.size());
  for (const SeenPlane& plane : seen) decisions.push_back(candidates.decide(plane));
  return decisions;
}

bool one_surface(const Map& map, PlaneId a, PlaneId b, double distance,
                 const PlaneAssociationOptions& options) {
  const Plane plane_a = map.plane_in_world(a), plane_b = map.plane_in_world(b);
  if (angle_between(plane_a, plane_b) > options.max_angle_deg * kRadians) return false;
  const auto outline_a = map.outline_in_world(a), outline_b = map.outline_in_world(b);
  const double margin = options.max_offset * distance;
  if (std::abs(plane_a.signed_distance(middle_of(outline_b))) > margin) return false;
  if (std::abs(plane_b.signed_distance(middle_of(outline_a))) > margin) return false;
  return touch(outline_a, outline_b, plane_b.normal(), margin) ||
         touch(outline_b, outline_a, plane_a.normal(), margin);
}

}  // namespace cairn
