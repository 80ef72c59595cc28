#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// Says of each born object on which plane it stands, if on one: a confirmed one that is level as
/// labels or most other such planes say, over whose outline its centre is, and from which its
/// lowest point is no farther than `max_gap` (metres), or `most_held` if it stood on it already.
/// Nothing while the scale is unknown. `metre`: in units of the map, 0: unknown.
void find_supports(Map& map, double metre, double max_gap, double most_held);

}  // namespace cairn
