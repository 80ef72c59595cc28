#include "cairn/association/plane_association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kGate = 3;     // σ
constexpr double kTouch = 0.3;  // between outlines that touch, as a share of the viewing distance
constexpr double kGap = 0.1;    // between planes that are one, where outlines have their middles
constexpr int kFewPoints = 10;  // fewer say little of a plane
constexpr double kMostPoints = 0.7;     // of one plane on another, that make the two one
constexpr double kAsGood = 0.7;         // of the points on what is seen, on what is known
constexpr double kLeastOffset = 0.015;  // share of the distance: surfaces are not flat
// Share of the distance. No surface is seen from behind: where a camera seems to be farther behind
// one, drift has brought two together, as opposite walls of a corridor.
constexpr double kBehind = 0.1;

// How far apart two views of one surface may be, from how sure both are.
double angle_gate(double sigma_a, double sigma_b, const PlaneAssociationOptions& options) {
  return std::min(kGate * std::hypot(sigma_a, sigma_b), options.max_angle_deg * kRadians);
}
double offset_gate(double sigma, double distance, const PlaneAssociationOptions& options) {
  return distance * std::clamp(kGate * sigma / distance, std::min(kLeastOffset, options.max_offset),
                               options.max_offset);
}

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

bool is_behind(const SeenPlane& seen, const KnownPlane& known) {
  return known.plane.offset() < -kBehind * seen.centroid.norm();
}

// 1 where the normals or the offsets are as far apart as is allowed; infinite from behind.
double disagreement(const SeenPlane& seen, const KnownPlane& known,
                    const PlaneAssociationOptions& options) {
  if (is_behind(seen, known)) return std::numeric_limits<double>::infinity();
  const double tilt = known.sigma_tilt * (seen.centroid - middle_of(known.outline)).norm();
  const double sigma = std::hypot(seen.sigma_offset, tilt);
  const double angle = angle_between(seen.plane, known.plane) /
                       angle_gate(seen.sigma_angle, known.sigma_tilt, options);
  const double offset = std::abs(known.plane.signed_distance(seen.centroid)) /
                        offset_gate(sigma, seen.centroid.norm(), options);
  return std::max(angle, offset);
}

// Where many points are shared, no σ is asked: they lie on both.
bool nearly_agree(const SeenPlane& seen, const KnownPlane& known,
                  const PlaneAssociationOptions& options) {
  return !is_behind(seen, known) &&
         angle_between(seen.plane, known.plane) <= options.max_angle_deg * kRadians &&
         std::abs(known.plane.signed_distance(seen.centroid)) <=
             options.max_offset * seen.centroid.norm();
}

class Candidates {
 public:
  Candidates(const Map& map, KeyframeId keyframe, const PlaneAssociationOptions& options)
      : map_(map), keyframe_(map.keyframes()[keyframe]), options_(options) {
    const SE3 T_kw = keyframe_.T_wc.inverse();
    map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
      known_.push_back(
          KnownPlane{id, map.plane_in_world(id), map.outline_in_world(id), landmark.sigma_tilt}
              .transformed(T_kw));
    });
  }

  PlaneDecision decide(const SeenPlane& seen) const {
    const std::vector<Eigen::Vector3d> points = map_.measured_points_at(keyframe_, seen.inner);
    const KnownPlane* best = nullptr;
    int most = 0;
    for (const KnownPlane& known : known_) {
      if (!nearly_agree(seen, known, options_)) continue;
      const int count = count_shared(known, points, kTouch * seen.centroid.norm());
      if (count <= most) continue;
      most = count;
      best = &known;
    }
    // A surface that is known explains the points as well as one that is fitted to them.
    const bool explained = most >= kAsGood * count_on(seen.plane, points);
    if (most >= options_.th_high && explained) return {PlaneDecision::Kind::kKnown, best->id};
    // Few keypoints, or those of a surface in front of this one: where it lies decides.
    const KnownPlane* nearest = nearest_surface(seen, known_, options_);
    if (nearest != nullptr) return {PlaneDecision::Kind::kKnown, nearest->id};
    return {most < options_.th_low ? PlaneDecision::Kind::kNew : PlaneDecision::Kind::kUnclear, {}};
  }

 private:
  bool lies_on(const Plane& plane, const Eigen::Vector3d& p) const {
    return std::abs(plane.signed_distance(p)) < kGate * options_.point_sigma * p.norm();
  }

  int count_on(const Plane& plane, const std::vector<Eigen::Vector3d>& points) const {
    return static_cast<int>(std::count_if(points.begin(), points.end(),
                                          [&](const auto& p) { return lies_on(plane, p); }));
  }

  // A box on a table may be as high as a counter elsewhere: near the outline only.
  int count_shared(const KnownPlane& known, const std::vector<Eigen::Vector3d>& points,
                   double margin) const {
    const Eigen::Vector3d n = known.plane.normal();
    return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const auto& p) {
      return lies_on(known.plane, p) && distance_outside(known.outline, n, p) <= margin;
    }));
  }

  const Map& map_;
  const Keyframe& keyframe_;
  PlaneAssociationOptions options_;
  std::vector<KnownPlane> known_;
};

// The share of a plane's measured points that lie on another plane; none where they are few.
std::optional<double> share_of_points_on(const Map& map, PlaneId of, const Plane& plane,
                                         const PlaneAssociationOptions& options) {
  int points = 0, on = 0;
  for (const PointId id : map.planes()[of].points) {
    const MapPoint& p = map.points()[id];
    if (p.assumed) continue;
    const double sigma = options.point_sigma * map.viewing_distance(id);
    ++points;
    on += std::abs(plane.signed_distance(p.position)) < kGate * sigma;
  }
  if (points < kFewPoints) return std::nullopt;
  return double(on) / points;
}

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

KnownPlane KnownPlane::transformed(const SE3& T_ba) const {
  return {id, plane.transformed(T_ba), cairn::transformed(outline, T_ba), sigma_tilt};
}

const KnownPlane* nearest_surface(const SeenPlane& seen, std::span<const KnownPlane> known,
                                  const PlaneAssociationOptions& options) {
  const KnownPlane* nearest = nullptr;
  double least = 1;
  const double margin = kTouch * seen.centroid.norm();
  for (const KnownPlane& plane : known) {
    const double off = disagreement(seen, plane, options);
    if (off > least) continue;
    const bool together =
        touch(seen.outline, plane.outline, plane.plane.normal(), margin) ||
        touch(plane.outline, convex_outline(seen.plane, seen.outline), seen.plane.normal(), margin);
    if (!together) continue;
    nearest = &plane;
    least = off;
  }
  return nearest;
}

bool one_surface(const Map& map, PlaneId a, PlaneId b, double distance,
                 const PlaneAssociationOptions& options) {
  const Plane plane_a = map.plane_in_world(a), plane_b = map.plane_in_world(b);
  if (angle_between(plane_a, plane_b) > options.max_angle_deg * kRadians) return false;
  if (plane_a.normal().dot(plane_b.normal()) < 0) return false;  // two sides are two surfaces
  const auto outline_a = map.outline_in_world(a), outline_b = map.outline_in_world(b);
  const double margin = kGap * distance;
  if (!touch(outline_a, outline_b, plane_b.normal(), kTouch * distance) &&
      !touch(outline_b, outline_a, plane_a.normal(), kTouch * distance)) {
    return false;
  }
  // The points say, where there are some.
  const auto a_on_b = share_of_points_on(map, a, plane_b, options);
  const auto b_on_a = share_of_points_on(map, b, plane_a, options);
  if (a_on_b || b_on_a) return std::max(a_on_b.value_or(0), b_on_a.value_or(0)) > kMostPoints;
  const double sigma_a = map.planes()[a].sigma_tilt, sigma_b = map.planes()[b].sigma_tilt;
  if (angle_between(plane_a, plane_b) > angle_gate(sigma_a, sigma_b, options)) return false;
  const Eigen::Vector3d middle_a = middle_of(outline_a), middle_b = middle_of(outline_b);
  return std::abs(plane_a.signed_distance(middle_b)) <= margin &&
         std::abs(plane_b.signed_distance(middle_a)) <= margin;
}

}  // namespace cairn
