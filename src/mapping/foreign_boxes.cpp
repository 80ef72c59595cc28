#include "cairn/mapping/foreign_boxes.h"

#include <algorithm>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/map/object_classes.h"

namespace cairn {
namespace {

constexpr double kExplained = 0.5;   // IoU with what is projected
constexpr double kFarBetter = 0.25;  // more than the box's own object has

struct Known {
  ObjectId id;
  Ellipsoid in_world;
  std::string class_name;
};

}  // namespace

double box_overlap(const Map& map, const Ellipsoid& in_world, const ObjectObservation& o) {
  const SE3 T_cw = map.camera_of(o).inverse();
  const auto box = projected_box(map.view().pinhole(), {T_cw * in_world.T, in_world.semi_axes});
  return box ? intersection_over_union(box->clipped(map.view().borders()), o.box) : 0;
}

void drop_foreign_boxes(Map& map) {
  std::vector<Known> all;
  map.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    if (landmark.born) all.push_back({id, map.object_in_world(id), landmark.class_name()});
  });
  for (const Known& known : all) {
    std::erase_if(map.objects()[known.id].observations, [&](const ObjectObservation& o) {
      const double enough = std::max(kExplained, box_overlap(map, known.in_world, o) + kFarBetter);
      return std::any_of(all.begin(), all.end(), [&](const Known& other) {
        return other.id != known.id && may_be_one_class(other.class_name, known.class_name) &&
               box_overlap(map, other.in_world, o) > enough;
      });
    });
  }
}

}  // namespace cairn
