#pragma once

#include <map>
#include <string>

#include "cairn/map/map.h"

namespace cairn::testing {

/// What is wrong with the links between keyframes and points, and with what is counted of them, in
/// words; empty if nothing is.
inline std::string broken_links(const Map& map) {
  std::string wrong;
  auto name = [](auto id) { return std::to_string(id.slot) + "." + std::to_string(id.generation); };
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    std::map<KeyframeId, int> shared;
    for (const PointId p : keyframe.points) {
      const MapPoint* point = map.points().find(p);
      if (point == nullptr) continue;
      for (const Observation& o : point->observations) ++shared[o.keyframe];
    }
    shared.erase(id);
    const auto counted = map.covisible(id, 0);
    if (std::map<KeyframeId, int>(counted.begin(), counted.end()) != shared) {
      wrong += "keyframe " + name(id) + " shares other points than are counted\n";
    }
    for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
      const PointId p = keyframe.points[i];
      if (!p.valid()) continue;
      if (!map.points().contains(p)) {
        wrong += "keyframe " + name(id) + " sees point " + name(p) + ", which is gone\n";
      } else if (map.keypoint_of(p, id) != static_cast<int>(i)) {
        wrong += "point " + name(p) + " does not know keyframe " + name(id) + "\n";
      }
    }
  });
  map.points().for_each([&](PointId id, const MapPoint& point) {
    if (point.observations.size() < 2) wrong += "point " + name(id) + " is seen less than twice\n";
    if (!point.position.allFinite()) wrong += "point " + name(id) + " is not finite\n";
    for (const Observation& o : point.observations) {
      const Keyframe* k = map.keyframes().find(o.keyframe);
      if (k == nullptr || k->points[o.keypoint] != id) {
        wrong += "keyframe " + name(o.keyframe) + " does not know point " + name(id) + "\n";
      }
    }
  });
  return wrong;
}

}  // namespace cairn::testing
