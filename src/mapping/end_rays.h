#pragma once

#include <utility>

#include "cairn/map/map.h"

namespace cairn {

/// The directions, unit and in the world, from which the first and the last keyframe that sees a
/// point look at it. The angle between them tells how well its depth is known.
inline std::pair<Eigen::Vector3d, Eigen::Vector3d> end_rays(const Map& map, const MapPoint& point) {
  const auto ray = [&](const Observation& o) -> Eigen::Vector3d {
    return (point.position - map.keyframes()[o.keyframe].T_wc.translation()).normalized();
  };
  return {ray(point.observations.front()), ray(point.observations.back())};
}

}  // namespace cairn
