#pragma once

#include "cairn/map/map.h"

namespace cairn {

struct PlaneMappingOptions;

/// Enough pictures show it, enough points carry it, and neither its neighbours' labels nor what
/// stands in its place deny it: what networks alone say of a surface is too rough for a map.
bool is_confirmed(const Map& map, PlaneId id, const PlaneMappingOptions& options);

/// Refines all planes by the map as it is now, and notes what speaks for and against each.
/// `finished`: no drift excuses a wall that leans any more.
void judge_planes(Map& map, const PlaneMappingOptions& options, bool finished = false);

/// Planes that were not seen within their probation, nor confirmed, go. `now`: seconds.
void cull_planes(Map& map, double now, const PlaneMappingOptions& options);

/// At the end: planes that were never confirmed go, but for bare walls and ceilings that many
/// pictures show.
void remove_unconfirmed_planes(Map& map, const PlaneMappingOptions& options);

/// After the full adjustment: the same anew, as points that were no good are gone and the others
/// are where they belong; so they may be spread by half as much, and no drift excuses a wall that
/// leans.
void settle_planes(Map& map, const PlaneMappingOptions& options);

}  // namespace cairn
