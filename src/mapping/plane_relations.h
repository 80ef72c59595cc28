#pragma once

#include <numbers>

#include "cairn/map/map.h"

namespace cairn {

struct PlaneMappingOptions;

/// Radians. Planes farther from parallel or perpendicular are something else, however little is
/// known of them.
inline constexpr double kMaxRelationAngle = 12 * std::numbers::pi / 180;
/// The same, where labels say how two stand to each other.
inline constexpr double kMaxImpliedAngle = 25 * std::numbers::pi / 180;

/// What no picture shows together may be turned against each other by what drifted in between.
bool seen_together(const PlaneLandmark& a, const PlaneLandmark& b);

/// Which confirmed planes are parallel or perpendicular, and which floors or ceilings are one. A
/// relation of angles begins where the angle is within two σ of it, and ends beyond three; where
/// only drift stands between two upright planes, within what buildings leave no doubt about. Floors
/// are one where pictures that show both show no step, and the map has them not too far apart.
void relate_planes(Map& map, const PlaneMappingOptions& options);

}  // namespace cairn
