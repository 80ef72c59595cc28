#pragma once

#include "cairn/map/map.h"
#include "cairn/system/slam.h"

namespace cairn {

/// How far keypoints lie from where the map's points project, over all observations of a map.
ReprojectionError reprojection_error(const Map& map);

}  // namespace cairn
