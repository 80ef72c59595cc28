#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// How far from flat a surface is: the robust spread of its measured points about the plane, as
/// shares of their viewing distances, less what their own errors make of it. Points are taken where
/// their observations alone would have them, not where the plane has drawn them: else what is held
/// to be flat would become it. 1 where no point tells.
double plane_roughness(const Map& map, PlaneId id);

}  // namespace cairn
