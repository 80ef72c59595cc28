#include "cairn/mapping/object_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cairn/map/plane_labels.h"

namespace cairn {
namespace {

constexpr double kReach = 1.15;  // of an outline: things stand at edges, too

struct Surface {
  PlaneId id;
  Plane plane;  // world, normal towards the side that things stand on
  std::vector<Eigen::Vector3d> outline;
};

// Level planes that carry things: their normal points to the cameras, which look down on them.
std::vector<Surface> surfaces(const Map& map) {
  std::vector<Surface> result;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!landmark.confirmed || !carries_things(landmark.label())) return;
    result.push_back({id, map.plane_in_world(id), map.outline_in_world(id)});
  });
  return result;
}

bool over(const Surface& surface, const Eigen::Vector3d& x) {
  const Eigen::Vector3d middle = middle_of(surface.outline), n = surface.plane.normal();
  const Eigen::Vector3d p = middle + (x - middle) / kReach;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < surface.outline.size(); ++i) {
    const Eigen::Vector3d& a = surface.outline[i];
    const Eigen::Vector3d& b = surface.outline[(i + 1) % surface.outline.size()];
    ((b - a).cross(p - a).dot(n) > 0 ? left : right)++;
  }
  return left == 0 || right == 0;
}

}  // namespace

void find_supports(Map& map, double metre, double max_gap, double most_held) {
  if (!(metre > 0)) return;
  const std::vector<Surface> all = surfaces(map);
  map.objects().for_each([&](ObjectId id, ObjectLandmark& landmark) {
    const PlaneId before = std::exchange(landmark.support, PlaneId{});
    if (!landmark.born) return;
    const Ellipsoid ellipsoid = map.object_in_world(id);
    double least = std::numeric_limits<double>::infinity();
    for (const Surface& surface : all) {
      const double height = surface.plane.signed_distance(ellipsoid.centre());
      const double gap = std::abs(height - ellipsoid.reach(surface.plane.normal())) / metre;
      const double most = surface.id == before ? most_held : max_gap;
      if (height <= 0 || gap > most || gap >= least || !over(surface, ellipsoid.centre())) continue;
      least = gap;
      landmark.support = surface.id;
    }
  });
}

}  // namespace cairn
