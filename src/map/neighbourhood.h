#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// Which covisible keyframes are neighbours.
struct Neighbours {
  int min_shared = 1;                                          ///< points
  std::size_t most = std::numeric_limits<std::size_t>::max();  ///< those that share most
};

/// The keyframe, its neighbours, then the neighbours of those (`second`); each once.
std::vector<KeyframeId> neighbourhood(const Map& map, KeyframeId id, const Neighbours& direct,
                                      const Neighbours& second);

}  // namespace cairn
