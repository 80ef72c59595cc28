#include "cairn/map/map_view.h"

#include <algorithm>

#include "cairn/map/id_set.h"
#include "cairn/map/neighbourhood.h"

namespace cairn {
namespace {

constexpr Neighbours kDirect = {.min_shared = 5};
constexpr Neighbours kOfNeighbours = {.min_shared = 5, .most = 5};

}  // namespace

std::uint32_t MapView::index_of(PointId id) const {
  const auto it = std::lower_bound(points.begin(), points.end(), id,
                                   [](const Point& p, PointId value) { return p.id < value; });
  if (it == points.end() || it->id != id) return kNone;
  return static_cast<std::uint32_t>(it - points.begin());
}

std::optional<SE3> MapView::pose_of(KeyframeId id) const {
  const auto it =
      std::lower_bound(keyframes.begin(), keyframes.end(), id,
                       [](const KeyframePose& k, KeyframeId value) { return k.id < value; });
  if (it == keyframes.end() || it->id != id) return std::nullopt;
  return it->T_wc;
}

std::shared_ptr<const MapView> make_view(const Map& map, KeyframeId reference, int max_points,
                                         std::uint64_t version) {
  auto view = std::make_shared<MapView>();
  view->version = version;
  view->reference = reference;
  view->reference_frame = map.keyframes()[reference].frame;
  view->reference_tracked = map.tracked_points(reference);
  view->median_depth = map.depth_quantile(reference, 0.5);
  view->newest = map.keyframes()[map.newest()].sequence;
  view->map_keyframes = map.keyframes().size();
  view->map_points = map.points().size();
  view->readout = map.readout();
  view->units_a_metre = map.units_a_metre;

  std::vector<PointId> ids;
  IdSet<PointId> taken;
  for (const KeyframeId id : neighbourhood(map, reference, kDirect, kOfNeighbours)) {
    const Keyframe& keyframe = map.keyframes()[id];
    view->keyframes.push_back({id, keyframe.T_wc});
    if (static_cast<int>(ids.size()) >= max_points) continue;
    for (const PointId p : keyframe.points) {
      if (p.valid() && taken.insert(p)) ids.push_back(p);
    }
  }
  std::sort(ids.begin(), ids.end());
  view->points.reserve(ids.size());
  for (const PointId id : ids) {
    const MapPoint& p = map.points()[id];
    view->points.push_back({id, p.position, p.normal, p.base_distance, p.descriptor, p.patch});
  }
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    view->planes.push_back({id, map.plane_in_world(id), landmark.label(), map.outline_in_world(id),
                            landmark.sigma_tilt, landmark.confirmed});
  });
  map.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    if (!landmark.born) return;
    view->objects.push_back({id, map.object_in_world(id), landmark.class_name()});
  });
  std::sort(view->keyframes.begin(), view->keyframes.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const PointId p : map.keyframes()[reference].points) {
    view->reference_points.push_back(p.valid() ? view->index_of(p) : MapView::kNone);
  }
  return view;
}

}  // namespace cairn
