#include "cairn/mapping/plane_relations.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cairn/map/plane_labels.h"
#include "cairn/mapping/plane_confirmation.h"
#include "cairn/mapping/plane_mapping.h"

namespace cairn {
namespace {

// Shares of the distance. A picture whose depth is off by a fifth is so all over: where it shows
// two floors, steps of more than the first show. In the map they may have drifted by the second.
constexpr double kStep = 0.06, kDrift = 0.4;

// Two planes, each by a place on it, without a step of more than `most` between them.
bool is_one_level(const Plane& a, const Eigen::Vector3d& on_a, const Plane& b,
                  const Eigen::Vector3d& on_b, double most) {
  return a.normal().dot(b.normal()) > std::cos(kMaxImpliedAngle) &&
         std::abs(a.signed_distance(on_b)) < most && std::abs(b.signed_distance(on_a)) < most;
}

// Do pictures that show both, if there are any, show one plane?
bool shown_as_one(const PlaneLandmark& a, const PlaneLandmark& b) {
  int together = 0, as_one = 0;
  for (const PlaneObservation& of_a : a.observations) {
    for (const PlaneObservation& of_b : b.observations) {
      if (of_a.keyframe != of_b.keyframe) continue;
      ++together;
      const double distance = std::min(of_a.centroid.norm(), of_b.centroid.norm());
      as_one +=
          is_one_level(Plane::through(of_a.centroid, of_a.normal), of_a.centroid,
                       Plane::through(of_b.centroid, of_b.normal), of_b.centroid, kStep * distance);
    }
  }
  return 2 * as_one >= together;
}

// A floor that became two landmarks while the scale drifted; or a ceiling.
bool are_one_level(const Map& map, PlaneId id_a, PlaneId id_b) {
  const PlaneLandmark &a = map.planes()[id_a], &b = map.planes()[id_b];
  if (a.label() != b.label() || !is_ended_by_walls(a.label())) return false;
  const double distance = std::min(viewing_distance(a), viewing_distance(b));
  return is_one_level(map.plane_in_world(id_a), middle_of(map.outline_in_world(id_a)),
                      map.plane_in_world(id_b), middle_of(map.outline_in_world(id_b)),
                      kDrift * distance) &&
         shown_as_one(a, b);
}

}  // namespace

bool seen_together(const PlaneLandmark& a, const PlaneLandmark& b) {
  return std::any_of(a.observations.begin(), a.observations.end(),
                     [&](const PlaneObservation& o) { return b.seen_by(o.keyframe); });
}

void relate_planes(Map& map, const PlaneMappingOptions& options) {
  struct Sure {
    PlaneId id;
    Plane plane;
    double sigma;
    std::string label;
  };
  std::vector<Sure> planes;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!is_confirmed(map, id, options)) return;
    planes.push_back({id, map.plane_in_world(id), landmark.sigma_tilt, landmark.label()});
  });
  const std::vector<RelatedPlanes> before = std::move(map.relations());
  map.relations().clear();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      if (are_one_level(map, planes[i].id, planes[k].id)) {
        map.relations().push_back({planes[i].id, planes[k].id, PlaneRelation::kCoplanar});
      }
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
        const double gate = implied   ? kMaxImpliedAngle
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

}  // namespace cairn
