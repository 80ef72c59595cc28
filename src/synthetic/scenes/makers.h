#pragma once

#include "cairn/synthetic/scene.h"

namespace cairn {

// One function a scene; make_scene chooses.
Scene make_desk(std::uint64_t seed);
Scene make_room(std::uint64_t seed);
Scene make_corridor(std::uint64_t seed);
Scene make_street(std::uint64_t seed);

}  // namespace cairn
