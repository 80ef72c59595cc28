#pragma once

#include "cairn/map/map.h"
#include "cairn/mapping/metric_scale.h"

namespace cairn {

/// The scale that makes things as large as things of their classes are: the robust mean over the
/// born objects of log (usual size / size), each as sure as its class's sizes and its own fit are.
/// Its σ has a part that things of one map share: tables of sizes are of the world, not of a room.
ScaleEstimate scale_from_sizes(const Map& map);

}  // namespace cairn
