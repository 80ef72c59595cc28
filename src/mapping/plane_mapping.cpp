#include "cairn/mapping/plane_mapping.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/geometry/median.h"
#include "cairn/map/plane_labels.h"
#include "cairn/mapping/plane_refinement.h"
#include "cairn/mapping/plane_roughness.h"
#include "cairn/mapping/upward.h"

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMinIndependent =
    1.5;                             // pictures: errors look alike for a while, surfaces for good
constexpr double kMaxStretch = 2.5;  // depth of a point on a plane over that of its centroid
// Planes farther from parallel or perpendicular are something else, however little is known of
// them.
constexpr double kMaxRelationAngle = 12 * kRadians;
constexpr double kMaxImplied = 25 * kRadians;  // the same, where labels say so
constexpr double kIndependentOfBare = 3;       // pictures that a surface without points must have
constexpr double kProbationOfBare = 30;        // seconds
constexpr double kMaxTiltOfBare = 2.5 * kRadians;
constexpr double kHalfway = 45 * kRadians;                   // between level and upright
constexpr double kShareOfClear = 0.9, kSpreadOfClear = 0.2;  // of max_spread
constexpr double kSpreadInTheEnd = 0.5;                      // of max_spread
constexpr double kLeastSlant = 4 * kRadians;                 // of a road seen from a car: seven
constexpr double kShareOfBare = 0.5;  // of the points in its masks, where there is one that tells

int measured_points(const Map& map, const Keyframe& keyframe) {
  return static_cast<int>(
      std::count_if(keyframe.points.begin(), keyframe.points.end(), [&](PointId p) {
        return p.valid() && !map.points()[p].assumed && map.points()[p].observations.size() > 1;
      }));
}

// A camera that turns sees what no second view has measured yet: where a plane or the predicted
// depth says how far a keypoint is, it becomes a point of the map.
PointId assume_point(Map& map, KeyframeId id, std::uint32_t keypoint, double depth) {
  const Keyframe& keyframe = map.keyframes()[id];
  const Eigen::Vector3d ray = map.view().pinhole().unproject(keyframe.frame->pixel(keypoint));
  const PointId p = map.add_point(keyframe.T_wc * (depth * ray));
  map.add_observation(p, id, keypoint);
  MapPoint& point = map.points()[p];
  point.assumed = true;
  point.colour = keyframe.frame->features.keypoints[keypoint].colour;
  point.born = keyframe.sequence;
  map.update_descriptor(p);
  map.update_geometry(p);
  return p;
}

void assume_points_on(Map& map, KeyframeId id, const SeenPlane& seen, PlaneId plane,
                      std::vector<PointId>& created) {
  const Keyframe& keyframe = map.keyframes()[id];
  const Plane in_camera = map.plane_in_world(plane).transformed(keyframe.T_wc.inverse());
  for (const std::uint32_t i : seen.keypoints) {
    if (keyframe.points[i].valid()) continue;
    const auto depth =
        in_camera.depth_along(map.view().pinhole().unproject(keyframe.frame->pixel(i)));
    if (!depth || *depth > kMaxStretch * seen.centroid.z()) continue;
    created.push_back(assume_point(map, id, i, *depth));
    map.set_plane_of(created.back(), plane);
  }
}

// From where a landmark is seen to its middle.
double viewing_distance(const Map& map, PlaneId id) {
  return middle_of(map.planes()[id].outline).norm();  // outlines are in the reference's frame
}

void fuse_planes(Map& map, const PlaneAssociationOptions& options) {
  std::vector<PlaneId> ids;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark&) { ids.push_back(id); });
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      if (!map.planes().contains(ids[i]) || !map.planes().contains(ids[k])) continue;
      const double distance =
          std::min(viewing_distance(map, ids[i]), viewing_distance(map, ids[k]));
      if (!one_surface(map, ids[i], ids[k], distance, options)) continue;
      // The better known one stays.
      const bool first = map.planes()[ids[i]].sightings >= map.planes()[ids[k]].sightings;
      spdlog::debug("planes: {} ({}) and {} ({}) are one surface", int(ids[i].slot),
                    map.planes()[ids[i]].label(), int(ids[k].slot), map.planes()[ids[k]].label());
      map.merge_planes(first ? ids[k] : ids[i], first ? ids[i] : ids[k]);
    }
  }
}

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

// What no picture shows together may be turned against each other by what drifted in between.
bool seen_together(const PlaneLandmark& a, const PlaneLandmark& b) {
  return std::any_of(a.observations.begin(), a.observations.end(),
                     [&](const PlaneObservation& o) { return b.seen_by(o.keyframe); });
}

// How far a plane may stand from what labels say of it and another one. Drift may have turned one
// against the other, unless one picture shows both; with Manhattan relations adjustments set that
// right. No drift lets walls lean in the end, but points on what stands before them.
double most_off(const PlaneLandmark& landmark, const PlaneLandmark& other, bool manhattan,
                bool finished) {
  const bool known = finished || (!manhattan && seen_together(landmark, other));
  return is_upright(landmark.label()) && known ? kMaxRelationAngle : kMaxImplied;
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
  const SE3& T_wr = map.keyframes()[landmark.reference].T_wc;
  const Eigen::Vector3d normal = T_wr.rotation() * landmark.plane.facing_origin().normal();
  std::vector<double> sines;
  for (const PlaneObservation& o : landmark.observations) {
    const SE3& T_wk = map.keyframes()[o.keyframe].T_wc;
    sines.push_back(-normal.dot(T_wk.rotation() * o.centroid.normalized()));
  }
  return sines.empty() ? kHalfway : std::asin(std::clamp(median(sines), -1.0, 1.0));
}

bool confirmed(const Map& map, PlaneId id, const PlaneMappingOptions& options) {
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

void log_plane(const Map& map, PlaneId id, const char* fate) {
  const PlaneLandmark& landmark = map.planes()[id];
  spdlog::debug(
      "plane {} ({}): {} pictures, {:.2f} of all, at {:.1f} deg, {} points, {:.2f} of all, spread "
      "{:.4f}, tilt {:.1f} deg{}: {}",
      int(id.slot), landmark.label(), landmark.sightings, landmark.detected,
      slant(map, id) / kRadians, landmark.points.size(), landmark.share, landmark.spread,
      landmark.sigma_tilt / kRadians, landmark.denied ? ", denied by labels" : "", fate);
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
    if (!late || confirmed(map, id, options)) return;
    log_plane(map, id, "forgotten");
    map.erase_plane(id);
  });
}

void update_evidence(Map& map, const PlaneMappingOptions& options, bool finished = false) {
  const std::optional<Upward> up = up_by_cameras(map);
  map.planes().for_each([&](PlaneId id, PlaneLandmark& landmark) {
    refine_landmark(map, id, options.association.point_sigma, options.manhattan);
    landmark.spread = spread(map, id);
    landmark.denied = denied_by_labels(map, id, up, options.manhattan, finished);
    landmark.confirmed = confirmed(map, id, options);
    if (landmark.confirmed) landmark.roughness = plane_roughness(map, id);
  });
}

// A relation begins where the angle is within two σ of it, and ends beyond three; where only drift
// stands between two upright planes, within what buildings leave no doubt about.
void relate_planes(Map& map, const PlaneMappingOptions& options) {
  struct Sure {
    PlaneId id;
    Plane plane;
    double sigma;
    std::string label;
  };
  std::vector<Sure> planes;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!confirmed(map, id, options)) return;
    planes.push_back({id, map.plane_in_world(id), landmark.sigma_tilt, landmark.label()});
  });
  const std::vector<RelatedPlanes> before = std::move(map.relations());
  map.relations().clear();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      const double sigma = std::hypot(planes[i].sigma, planes[k].sigma);
      const bool drifted = is_upright(planes[i].label) && is_upright(planes[k].label) &&
                           !seen_together(map.planes()[planes[i].id], map.planes()[planes[k].id]);
      const auto implied = implied_relation(planes[i].label, planes[k].label);
      for (const auto relation : {PlaneRelation::kParallel, PlaneRelation::kPerpendicular}) {
        const double off = angle_off(relation, planes[i].plane, planes[k].plane);
        const bool held = std::any_of(before.begin(), before.end(), [&](const RelatedPlanes& r) {
          return r.a == planes[i].id && r.b == planes[k].id && r.relation == relation;
        });
        if (implied && *implied != relation) continue;
        const double gate = implied   ? kMaxImplied
                            : drifted ? kMaxRelationAngle
                                      : std::min((held ? 3 : 2) * sigma, kMaxRelationAngle);
        if (off < gate) {
          map.relations().push_back({planes[i].id, planes[k].id, relation});
          break;
        }
      }
    }
  }
}

void keep_confirmed(Map& map, const PlaneMappingOptions& options, bool finished) {
  update_evidence(map, options, finished);
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    const bool stays = landmark.confirmed || (is_bare_surface(landmark, options) &&
                                              landmark.independent >= kIndependentOfBare);
    log_plane(map, id, stays ? "kept" : "refused");
    if (!stays) map.erase_plane(id);
  });
}

}  // namespace

std::vector<PointId> map_planes(Map& map, KeyframeId id, const KeyframePerception& seen,
                                const DepthScale& scale, const PlaneMappingOptions& options) {
  const Keyframe& keyframe = map.keyframes()[id];
  update_evidence(map, options);  // the map has been adjusted
  std::vector<SeenPlane> planes, raw;
  const auto in_units = [](const SeenPlane& plane, double units, double sigma) {
    SeenPlane result = plane.scaled(units);
    result.sigma_offset = std::max(result.sigma_offset, sigma * result.centroid.norm());
    return result;
  };
  for (const SeenPlane& plane : seen.planes) {
    // What pictures say of lengths is what all of them say: so planes hold the unit of the map.
    raw.push_back(
        in_units(plane, scale.everywhere, std::hypot(scale.sigma_here, scale.sigma_everywhere)));
    planes.push_back(in_units(plane, scale.here, scale.sigma_here));
    refine_plane(planes.back(),
                 plane_points(map, keyframe, plane.inner, options.association.point_sigma),
                 options.association.point_sigma);
  }
  const bool poor = measured_points(map, keyframe) < options.few_points;
  std::vector<PointId> created;
  const std::vector<PlaneDecision> decisions =
      associate_planes(map, id, planes, options.association);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    PlaneId plane = decisions[i].plane;
    if (decisions[i].kind == PlaneDecision::Kind::kUnclear) continue;
    if (decisions[i].kind == PlaneDecision::Kind::kNew) {
      plane = map.add_plane(id, planes[i]);
      // The factor is of what the network said; the points have factors of their own.
      PlaneObservation& first = map.planes()[plane].observations.front();
      first.normal = raw[i].plane.facing_origin().normal();
      first.centroid = raw[i].centroid;
      first.sigma_angle = raw[i].sigma_angle;
      first.sigma_offset = raw[i].sigma_offset;
    } else {
      map.observe_plane(plane, id, raw[i]);
    }
    if (poor) assume_points_on(map, id, planes[i], plane, created);
  }
  for (std::uint32_t i = 0; poor && i < keyframe.frame->corners(); ++i) {
    if (keyframe.points[i].valid() || !(seen.depth[i] > 0)) continue;
    created.push_back(assume_point(
        map, id, i, scale.here * stretched_depth(seen.depth[i], seen.range, map.depth_contrast)));
  }
  update_evidence(map, options);
  fuse_planes(map, options.association);
  cull_planes(map, keyframe.timestamp(), options);
  if (options.manhattan) relate_planes(map, options);
  std::erase_if(created, [&](PointId p) { return !map.points().contains(p); });
  return created;
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
