#include "cairn/map/seen_points.h"

#include <algorithm>

namespace cairn {

std::vector<PointId> points_seen_from(const Map& map, std::span<const KeyframeId> keyframes,
                                      SeenBy by) {
  std::vector<PointId> points;
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = map.keyframes()[id];
    const std::size_t keypoints =
        by == SeenBy::kCorners ? keyframe.frame->corners() : keyframe.points.size();
    for (std::size_t i = 0; i < keypoints; ++i) {
      if (keyframe.points[i].valid()) points.push_back(keyframe.points[i]);
    }
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace cairn
