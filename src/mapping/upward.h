#pragma once

#include <optional>

#include "cairn/map/map.h"

namespace cairn {

/// The direction in which no camera is rolled: people hold cameras level, and so do cars. None
/// where the cameras have hardly turned: then their pitch could be anything.
std::optional<Upward> up_by_cameras(const Map& map);

/// Up is the normal of the floor or table that most pictures saw; without one, what cameras
/// say.
std::optional<Upward> find_up(const Map& map);

}  // namespace cairn
