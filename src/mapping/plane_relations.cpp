#include "cairn/mapping/plane_relations.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cairn/map/plane_labels.h"
#include "cairn/mapping/plane_confirmation.h"
#include "cairn/mapping/plane_mapping.h"

namespace cairn {

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
