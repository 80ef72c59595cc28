#pragma once

#include <optional>
#include <string>

#include "cairn/map/plane_landmark.h"

namespace cairn {

/// What two labels say of their surfaces: floors, ceilings and tables are level, walls and doors
/// upright. None of two upright ones, which may meet at any angle, and of labels that say nothing.
std::optional<PlaneRelation> implied_relation(const std::string& a, const std::string& b);

/// Of floors, ceilings and the like.
bool is_level(const std::string& label);

/// Of walls, doors and the like.
bool is_upright(const std::string& label);

/// Of what things stand on: floors, tables, roads.
bool carries_things(const std::string& label);

/// Of floors and ceilings, which go on behind all that stands on them until a wall ends them.
bool is_ended_by_walls(const std::string& label);

}  // namespace cairn
