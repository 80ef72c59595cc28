#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// Calls `visit(const MapPoint&)` for each point of the map that the keyframe sees in the box (in
/// pixels).
template <class Visitor>
void for_each_point_in(const Box2& box, const Map& map, const Keyframe& keyframe, Visitor&& visit) {
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    const MapPoint* point = map.points().find(keyframe.points[i]);
    if (point != nullptr && box.contains(keyframe.frame->pixel(i))) visit(*point);
  }
}

}  // namespace cairn
