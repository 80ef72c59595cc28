#include "cairn/map/seen_points.h"

#include <algorithm>

#include "cairn/map/id_set.h"

namespace cairn {

std::vector<PointId> points_seen_from(const Map& map, std::span<const KeyframeId> keyframes,
                                      SeenBy by) {
  std::vector<PointId> points;
  IdSet<PointId> taken;
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = map.keyframes()[id];
    const std::size_t keypoints =
        by == SeenBy::kCorners ? keyframe.frame->corners() : keyframe.points.size();
    for (std::size_t i = 0; i < keypoints; ++i) {
      const PointId p = keyframe.points[i];
      if (p.valid() && taken.insert(p)) points.push_back(p);
    }
  }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace cairn
