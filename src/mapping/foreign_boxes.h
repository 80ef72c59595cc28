#pragma once

#include "cairn/map/map.h"

namespace cairn {

/// IoU of a box with what its picture should show of an ellipsoid; 0 if nothing.
double box_overlap(const Map& map, const Ellipsoid& in_world, const ObjectObservation& o);

/// Takes boxes from objects that another object of the same family explains far better. Of two
/// screens side by side, seen again after a while, some boxes of the one are given to the other
/// while little is known of either; then the boxes of the other disagree, and it would be refused.
void drop_foreign_boxes(Map& map);

}  // namespace cairn
