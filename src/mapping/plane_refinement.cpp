#include "cairn/mapping/plane_refinement.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "cairn/geometry/median.h"
#include "cairn/map/independent_pictures.h"
#include "cairn/map/plane_labels.h"
#include "cairn/mapping/plane_evidence.h"

namespace cairn {
namespace {

constexpr double kGate = 3;              // σ
constexpr double kMinTiltSigma = 0.017;  // a degree: walls are no better
constexpr std::size_t kFewPoints = 6;    // far from the rims: then those at the rims count, too
constexpr double kWellKnown = 0.023;     // of its normal, radians
constexpr double kStructureGate = 2;     // σ of the angle
constexpr double kMaxStructure = 0.14;   // eight degrees, however little is known
constexpr double kMaxImplied = 0.5;      // thirty degrees, where labels say so
constexpr double kMaxSquare = 0.38;      // twenty-two degrees, of two upright ones
constexpr std::size_t kManyPoints = 25;
constexpr int kWellSeen = 3;    // points of a plane, that a picture should show it
constexpr double kPixel = 0.7;  // of where a keypoint is, over all its observations
constexpr double kUnsure = 2;   // points much less sure than surfaces are flat say nothing
// Things stand before surfaces, and masks are rough; what is behind a surface is hidden by it.
constexpr double kOfThingsBefore = 0.5;
constexpr double kPlace = 5;  // side of a place, in σ by which surfaces are not flat
// Floors and ceilings end at walls, and have corners there if anywhere: doors begin, skirting
// boards end. So much closer to the plane they must be than those in its masks.
constexpr double kBeside = 2.0 / 3;
constexpr std::size_t kBare = 100;  // points in the masks of a floor: with more these do without

// In the world. Its depth is as sure as the rays of its observations are apart.
PlanePoint plane_point(const Map& map, PointId id, double point_sigma) {
  const MapPoint& point = map.points()[id];
  const Keyframe& eye = map.keyframes()[point.observations.front().keyframe];
  const Eigen::Vector3d ray = point.position - eye.T_wc.translation();
  double sine = 0;
  for (const Observation& o : point.observations) {
    const Eigen::Vector3d other = point.position - map.keyframes()[o.keyframe].T_wc.translation();
    sine = std::max(sine, ray.cross(other).norm() / (ray.norm() * other.norm()));
  }
  const double sigma_depth = kPixel / map.view().pinhole().fx / std::max(sine, 1e-9);
  return {point.position, point_sigma * ray.norm(), std::min(sigma_depth, 1.0) * ray};
}

// Things have more corners than the surfaces that they stand on: points of one place of a plane are
// one witness together.
void add_points(PlaneEvidence& evidence, const Map& map, const Plane& plane,
                const std::vector<PointId>& ids, double point_sigma) {
  std::vector<PlanePoint> points;
  std::vector<double> sigmas;
  for (const PointId id : ids) {
    points.push_back(plane_point(map, id, point_sigma));
    sigmas.push_back(points.back().sigma);
  }
  if (points.empty()) return;
  const double side = kPlace * median(sigmas);
  const Eigen::Vector3d u = plane.normal().unitOrthogonal(), v = plane.normal().cross(u);
  const auto place_of = [&](const PlanePoint& p) {
    return std::pair(std::floor(u.dot(p.position) / side), std::floor(v.dot(p.position) / side));
  };
  std::map<std::pair<double, double>, int> crowds;
  for (const PlanePoint& p : points) ++crowds[place_of(p)];
  for (PlanePoint& p : points) {
    p.worth = 1.0 / crowds[place_of(p)];
    evidence.add_point(p);
  }
}

// What pictures say of a landmark, in the world.
PlaneEvidence pictures_of(const Map& map, PlaneId id) {
  const PlaneLandmark& landmark = map.planes()[id];
  const Eigen::Vector3d now = map.plane_in_world(id).normal();
  const double alike = std::sqrt(double(landmark.observations.size()) / landmark.independent);
  PlaneEvidence evidence;
  for (const PlaneObservation& o : landmark.observations) {
    const SE3& T_wk = map.keyframes()[o.keyframe].T_wc;
    const Eigen::Vector3d n = T_wk.rotation() * o.normal;
    evidence.add_normal(n.dot(now) < 0 ? -n : n, alike * o.sigma_angle);
    evidence.add_place(T_wk * o.centroid, alike * o.sigma_offset);
  }
  return evidence;
}

double normal_sigma(const Map& map, PlaneId id, const PlaneFit& fit,
                    const PlaneEvidence& evidence) {
  return evidence.sigma_angle(fit, middle_of(map.outline_in_world(id)));
}

bool has_few_points(const PlaneLandmark& landmark) { return landmark.points.size() < kManyPoints; }

// What an upright plane with few points stands square to: the upright one that most pictures show.
PlaneId wall_for(const Map& map, PlaneId id) {
  PlaneId best;
  const PlaneLandmark& landmark = map.planes()[id];
  std::uint32_t most = landmark.sightings;
  if (!has_few_points(landmark) || !is_upright(landmark.label())) return best;
  map.planes().for_each([&](PlaneId other, const PlaneLandmark& known) {
    if (other == id || !known.confirmed || !is_upright(known.label())) return;
    if (known.sightings <= most) return;
    most = known.sightings;
    best = other;
  });
  return best;
}

// It was confirmed before there was a wall to tell.
bool is_askew(const Map& map, PlaneId id) {
  const PlaneId wall = wall_for(map, id);
  if (!wall.valid()) return false;
  const Plane plane = map.plane_in_world(id), other = map.plane_in_world(wall);
  return angle_off(PlaneRelation::kParallel, plane, other) > kMaxStructure &&
         angle_off(PlaneRelation::kPerpendicular, plane, other) > kMaxStructure;
}

// Of a plane of which little is known: if it is parallel or perpendicular to well-known ones, as
// far as can be told, it is. Where labels say how the two stand, only the normals of its pictures
// must not deny it, as a few points may be of anything. Many may not: what they deny is then for
// the adjustment to mend, as it may be drift between the two.
void add_structure(const Map& map, PlaneId id, const PlaneFit& fit, PlaneEvidence& evidence) {
  const PlaneLandmark& landmark = map.planes()[id];
  const Plane seen = landmark.observations.empty() ? fit.plane : Plane(evidence.mean_normal(), 0);
  const double sigma = normal_sigma(map, id, fit, evidence);
  const bool few = has_few_points(landmark);
  const PlaneId wall = wall_for(map, id);
  map.planes().for_each([&](PlaneId other, const PlaneLandmark& known) {
    if (!known.confirmed || other == id) return;
    const Plane stands = map.plane_in_world(other);
    const auto implied =
        few ? implied_relation(landmark.label(), known.label()) : std::optional<PlaneRelation>();
    const bool square = other == wall;
    const double gate =
        implied  ? kMaxImplied
        : square ? kMaxSquare
                 : std::min(kStructureGate * std::hypot(sigma, known.sigma_tilt), kMaxStructure);
    const Plane& plane = implied || square ? seen : fit.plane;
    const double sure = std::hypot(kMinTiltSigma, known.sigma_tilt);
    const auto is = [&](PlaneRelation relation) {
      return (!implied || *implied == relation) && angle_off(relation, plane, stands) < gate;
    };
    const Eigen::Vector3d n = stands.normal();
    if (is(PlaneRelation::kParallel)) evidence.add_normal(plane.normal().dot(n) < 0 ? -n : n, sure);
    if (is(PlaneRelation::kPerpendicular)) evidence.add_direction(n, sure);
  });
}

// Returns how sure its normal is.
double fit_to(Map& map, PlaneId id, const std::vector<PointId>& points, double point_sigma,
              bool manhattan) {
  PlaneEvidence evidence = pictures_of(map, id);
  PlaneLandmark& landmark = map.planes()[id];
  PlaneFit fit{map.plane_in_world(id)};
  add_points(evidence, map, fit.plane, points, point_sigma);
  fit = evidence.solve(fit.plane).value_or(fit);
  if (manhattan) {
    add_structure(map, id, fit, evidence);
    fit = evidence.solve(fit.plane).value_or(fit);
  }
  const double sigma = normal_sigma(map, id, fit, evidence);
  landmark.plane = fit.plane.transformed(map.keyframes()[landmark.reference].T_wc.inverse());
  return std::hypot(kMinTiltSigma, sigma);
}

// Most keyframes that observe the plane are on its positive side.
void face_viewers(const Map& map, PlaneLandmark& landmark) {
  const SE3 T_rw = map.keyframes()[landmark.reference].T_wc.inverse();
  const auto behind = std::count_if(
      landmark.observations.begin(), landmark.observations.end(), [&](const PlaneObservation& o) {
        const Eigen::Vector3d camera = T_rw * map.keyframes()[o.keyframe].T_wc.translation();
        return landmark.plane.signed_distance(camera) < 0;
      });
  if (2 * behind > std::ssize(landmark.observations)) landmark.plane = landmark.plane.flipped();
}

// By corners: what they missed is found also at rims and in the blur, where no detector could tell.
double detection_rate(const Map& map, const PlaneLandmark& landmark) {
  std::map<KeyframeId, int> points_seen;
  for (const PointId p : landmark.points) {
    for (const Observation& o : map.points()[p].observations) {
      if (map.is_corner(o)) ++points_seen[o.keyframe];
    }
  }
  int chances = 0, detections = 0;
  for (const auto& [keyframe, count] : points_seen) {
    if (count < kWellSeen || map.keyframes()[keyframe].depth.empty()) continue;
    ++chances;
    detections += landmark.seen_by(keyframe);
  }
  return chances > 0 ? double(detections) / chances : 1;  // none denies it
}

double tilt_sigma(const Map& map, PlaneId id, double point_sigma, bool manhattan) {
  PlaneEvidence evidence = pictures_of(map, id);
  std::vector<PointId> points = map.planes()[id].points;
  std::erase_if(points, [&](PointId p) { return map.points()[p].assumed; });
  const PlaneFit fit{map.plane_in_world(id)};
  add_points(evidence, map, fit.plane, points, point_sigma);
  if (manhattan) add_structure(map, id, fit, evidence);
  return std::hypot(kMinTiltSigma, normal_sigma(map, id, fit, evidence));
}

// Points whose depth is sure enough to tell.
struct SortedPoints {
  std::vector<PointId> on;
  int before = 0, behind = 0;
};

SortedPoints sort_points(const Map& map, PlaneId id, const std::vector<PointId>& points,
                         double point_sigma) {
  const Plane plane = map.plane_in_world(id);  // positive: before it
  SortedPoints result;
  for (const PointId p : points) {
    const PlanePoint point = plane_point(map, p, point_sigma);
    const double sigma = point.sigma_off(plane);
    if (sigma > kUnsure * point.sigma) continue;
    const double off = plane.signed_distance(point.position);
    if (std::abs(off) < kGate * sigma) {
      result.on.push_back(p);
    } else {
      ++(off > 0 ? result.before : result.behind);
    }
  }
  return result;
}

// Those at the rims of its masks, too: a plane that is well known tells them from what stands in
// front of it. And just outside of them, where it is a bare one that walls end.
std::vector<PointId> all_on(const Map& map, PlaneId id, const MaskedPoints& masked,
                            double point_sigma) {
  auto with_rim = sort_points(map, id, masked.all, point_sigma).on;
  if (!is_ended_by_walls(map.planes()[id].label()) || with_rim.size() >= kBare) return with_rim;
  const auto near = sort_points(map, id, masked.near, kBeside * point_sigma).on;
  std::vector<PointId> result;
  std::set_union(with_rim.begin(), with_rim.end(), near.begin(), near.end(),
                 std::back_inserter(result));
  return result;
}

// Points in order. One that lies on another plane already stays there.
void set_members(Map& map, PlaneId id, const std::vector<PointId>& points) {
  const std::vector<PointId> before = map.planes()[id].points;
  for (const PointId p : before) {
    const bool stays =
        std::binary_search(points.begin(), points.end(), p) || map.points()[p].assumed;
    if (!stays) map.set_plane_of(p, {});
  }
  for (const PointId p : points) {
    if (!map.points()[p].plane.valid()) map.set_plane_of(p, id);
  }
}

}  // namespace

std::vector<PlanePoint> plane_points(const Map& map, const Keyframe& keyframe,
                                     const std::vector<std::uint32_t>& keypoints,
                                     double point_sigma) {
  const SE3 T_kw = keyframe.T_wc.inverse();
  std::vector<PlanePoint> points;
  for (const std::uint32_t i : keypoints) {
    const PointId id = keyframe.points[i];
    if (!map.points().contains(id) || map.points()[id].assumed) continue;
    const PlanePoint point = plane_point(map, id, point_sigma);
    points.push_back({T_kw * point.position, point.sigma, T_kw.rotation() * point.along});
  }
  return points;
}

int refine_plane(SeenPlane& seen, std::span<const PlanePoint> points, double point_sigma) {
  seen.plane = seen.plane.facing_origin();
  PlaneEvidence evidence;
  evidence.add_normal(seen.plane.normal(), seen.sigma_angle);
  evidence.add_place(seen.centroid, seen.sigma_offset);
  for (const PlanePoint& p : points) evidence.add_point(p);
  const auto fit = evidence.solve(seen.plane);
  if (!fit) return 0;
  const Plane& plane = fit->plane;
  const Eigen::Vector3d n = plane.normal();
  seen.plane = plane;
  seen.centroid -= plane.signed_distance(seen.centroid) * n;
  for (Eigen::Vector3d& corner : seen.outline) corner -= plane.signed_distance(corner) * n;
  seen.sigma_angle = std::hypot(kMinTiltSigma, evidence.sigma_angle(*fit, seen.centroid));
  seen.sigma_offset =
      std::hypot(point_sigma * seen.centroid.norm(), evidence.sigma_place(*fit, seen.centroid));
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const PlanePoint& p) {
    return std::abs(plane.signed_distance(p.position)) < kGate * p.sigma_off(plane);
  }));
}

void refine_landmark(Map& map, PlaneId id, double point_sigma, bool manhattan) {
  PlaneLandmark& landmark = map.planes()[id];
  std::vector<double> times;
  for (const PlaneObservation& o : landmark.observations) {
    times.push_back(map.keyframes()[o.keyframe].timestamp());
  }
  landmark.independent = independent_pictures(std::move(times));
  MaskedPoints masked = map.points_in_masks(id);
  for (auto* points : {&masked.inner, &masked.all, &masked.near}) {
    std::erase_if(*points, [&](PointId p) { return map.points()[p].assumed; });
  }
  const auto& seen = masked.inner.size() < kFewPoints ? masked.all : masked.inner;
  if (!landmark.confirmed || (manhattan && is_askew(map, id))) {
    landmark.sigma_tilt = fit_to(map, id, masked.all, point_sigma, manhattan);
  } else {
    landmark.sigma_tilt = tilt_sigma(map, id, point_sigma, manhattan);
  }
  face_viewers(map, landmark);
  const auto [on, before, behind] = sort_points(map, id, seen, point_sigma);
  const double there = double(on.size());
  landmark.judges = there + behind + kOfThingsBefore * before;
  landmark.share = on.empty() ? 0 : there / landmark.judges;
  const bool well_known = landmark.sigma_tilt < kWellKnown;
  set_members(map, id, well_known ? all_on(map, id, masked, point_sigma) : on);
  landmark.detected = detection_rate(map, landmark);
  map.update_outline(id);
}

}  // namespace cairn
