#include "cairn/mapping/plane_confirmation.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/median.h"
#include "cairn/map/plane_labels.h"
#include "cairn/mapping/plane_mapping.h"
#include "cairn/mapping/plane_refinement.h"
#include "cairn/mapping/plane_relations.h"
#include "cairn/mapping/plane_roughness.h"
#include "cairn/mapping/upward.h"

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
// Pictures: errors look alike for a while, surfaces do so for good.
constexpr double kMinIndependent = 1.5;
constexpr double kIndependentOfBare = 3;  // pictures that a surface without points must have
constexpr double kProbationOfBare = 30;   // seconds
constexpr double kMaxTiltOfBare = 2.5 * kRadians;
constexpr double kShareOfBare = 0.5;        // of the points in its masks that can tell
constexpr double kHalfway = 45 * kRadians;  // between level and upright
constexpr double kShareOfClear = 0.9, kSpreadOfClear = 0.2;  // of max_spread
constexpr double kSpreadInTheEnd = 0.5;                      // of max_spread
constexpr double kLeastSlant = 4 * kRadians;                 // of a road seen from a car: seven

double spread(const Map& map, PlaneId id) {
  const Plane plane = map.plane_in_world(id);
  std::vector<double> off;
  for (const PointId p : map.planes()[id].points) {
    const MapPoint& point = map.points()[p];
    if (point.assumed) continue;
    off.push_back(std::abs(plane.signed_distance(point.position)) / map.viewing_distance(p));
  }
  return off.empty() ? 1 : robust_sigma(off);
}

// A table that is called a wall: it stands nearer to what the label excludes.
bool is_mislabelled(const Map& map, PlaneId id, const std::optional<Upward>& up) {
  if (!up) return false;
  const std::string& label = map.planes()[id].label();
  const double lean =
      angle_off(PlaneRelation::kParallel, map.plane_in_world(id), Plane(up->direction, 0));
  return lean < kHalfway ? is_upright(label) : is_level(label);
}

// How far a plane may stand from what labels say of it and another one. Drift may have turned one
// against the other, unless one picture shows both; with Manhattan relations adjustments set that
// right. No drift lets walls lean in the end, but points on what stands before them.
double most_off(const PlaneLandmark& landmark, const PlaneLandmark& other, bool manhattan,
                bool finished) {
  const bool known = finished || (!manhattan && seen_together(landmark, other));
  return is_upright(landmark.label()) && known ? kMaxRelationAngle : kMaxImpliedAngle;
}

// Labels say how two planes stand to each other. By far not so: one of the two is a phantom, or has
// a wrong label. Pictures vote, its own for it.
bool denied_by_labels(const Map& map, PlaneId id, const std::optional<Upward>& up, bool manhattan,
                      bool finished) {
  const PlaneLandmark& landmark = map.planes()[id];
  const Plane plane = map.plane_in_world(id);
  std::size_t yes = landmark.sightings, no = 0;
  map.planes().for_each([&](PlaneId other, const PlaneLandmark& known) {
    const auto implied = implied_relation(landmark.label(), known.label());
    if (other == id || !known.confirmed || !implied || is_mislabelled(map, other, up)) return;
    const double off = angle_off(*implied, plane, map.plane_in_world(other));
    (off < most_off(landmark, known, manhattan, finished) ? yes : no) += known.sightings;
  });
  return no > yes;
}

// A ceiling or a wall without a mark on it: no point says where it lies, nor that it does not. With
// Manhattan relations the others say how it stands, and many pictures how far off it is. The few
// points that can tell must not deny it.
bool is_bare_surface(const PlaneLandmark& landmark, const PlaneMappingOptions& options) {
  const bool points_agree = landmark.judges < 1 || landmark.share >= kShareOfBare;
  return options.manhattan && !landmark.denied && points_agree &&
         landmark.judges < options.min_points &&
         static_cast<int>(landmark.sightings) >= options.min_sightings &&
         landmark.sigma_tilt <= kMaxTiltOfBare &&
         (is_level(landmark.label()) || is_upright(landmark.label()));
}

// So flat, and with so little off it, that it is no mixture: a detector may miss it more often.
bool is_clear(const PlaneLandmark& landmark, const PlaneMappingOptions& options) {
  return landmark.share >= kShareOfClear && landmark.spread <= kSpreadOfClear * options.max_spread;
}

// The angle between the plane and the rays on which most pictures show it, negative from behind: no
// picture shows a surface edge-on.
double slant(const Map& map, PlaneId id) {
  const PlaneLandmark& landmark = map.planes()[id];
  const Eigen::Vector3d normal = map.plane_in_world(id).normal();
  std::vector<double> sines;
  for (const PlaneObservation& o : landmark.observations) {
    const SE3& T_wk = map.keyframes()[o.keyframe].T_wc;
    sines.push_back(-normal.dot(T_wk.rotation() * o.centroid.normalized()));
  }
  return sines.empty() ? kHalfway : std::asin(std::clamp(median(sines), -1.0, 1.0));
}

void log_plane(const Map& map, PlaneId id, const char* fate) {
  const PlaneLandmark& landmark = map.planes()[id];
  spdlog::debug(
      "plane {} ({}): {} pictures, {:.2f} of all, at {:.1f} deg, {} points, {:.2f} of all, spread "
      "{:.4f}, tilt {:.1f} deg{}: {}",
      int(id.slot), landmark.label(), landmark.sightings, landmark.detected,
      slant(map, id) / kRadians, landmark.points.size(), landmark.share, landmark.spread,
      landmark.sigma_tilt / kRadians, landmark.denied ? ", denied by labels" : "", fate);
}

void keep_confirmed(Map& map, const PlaneMappingOptions& options, bool finished) {
  judge_planes(map, options, finished);
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    const bool stays = landmark.confirmed || (is_bare_surface(landmark, options) &&
                                              landmark.independent >= kIndependentOfBare);
    log_plane(map, id, stays ? "kept" : "refused");
    if (!stays) map.erase_plane(id);
  });
}

}  // namespace

bool is_confirmed(const Map& map, PlaneId id, const PlaneMappingOptions& options) {
  const PlaneLandmark& landmark = map.planes()[id];
  const auto measured = std::count_if(landmark.points.begin(), landmark.points.end(),
                                      [&](PointId p) { return !map.points()[p].assumed; });
  return !landmark.denied && static_cast<int>(landmark.sightings) >= options.min_sightings &&
         landmark.independent >= kMinIndependent && slant(map, id) >= kLeastSlant &&
         static_cast<int>(measured) >= options.min_points &&
         landmark.sigma_tilt <= options.max_tilt_sigma_deg * kRadians &&
         landmark.spread <= options.max_spread && landmark.share >= options.min_share &&
         landmark.detected >= (is_clear(landmark, options) ? 0.5 : 1.0) * options.min_detected;
}

void judge_planes(Map& map, const PlaneMappingOptions& options, bool finished) {
  const std::optional<Upward> up = up_by_cameras(map);
  map.planes().for_each([&](PlaneId id, PlaneLandmark& landmark) {
    refine_landmark(map, id, options.association.point_sigma, options.manhattan);
    landmark.spread = spread(map, id);
    landmark.denied = denied_by_labels(map, id, up, options.manhattan, finished);
    landmark.confirmed = is_confirmed(map, id, options);
    if (landmark.confirmed) landmark.roughness = plane_roughness(map, id);
  });
}

void cull_planes(Map& map, double now, const PlaneMappingOptions& options) {
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    // Only pictures say where a bare surface is: it needs more of them, and time until they come.
    const double probation =
        is_bare_surface(landmark, options) ? kProbationOfBare : options.probation;
    const auto seen_lately = [&](const PlaneObservation& o) {
      return now - map.keyframes()[o.keyframe].timestamp() <= probation;
    };
    const bool late =
        std::none_of(landmark.observations.begin(), landmark.observations.end(), seen_lately);
    if (!late || is_confirmed(map, id, options)) return;
    log_plane(map, id, "forgotten");
    map.erase_plane(id);
  });
}

void remove_unconfirmed_planes(Map& map, const PlaneMappingOptions& options) {
  keep_confirmed(map, options, false);
}

void settle_planes(Map& map, const PlaneMappingOptions& options) {
  PlaneMappingOptions settled = options;
  settled.max_spread *= kSpreadInTheEnd;
  keep_confirmed(map, settled, true);
}

}  // namespace cairn
