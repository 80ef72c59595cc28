#pragma once

#include <vector>

#include "cairn/map/map.h"
#include "cairn/mapping/plane_mapping.h"
#include "cairn/system/slam.h"

namespace cairn {

/// The planes of a map in its world, in order of ids, with what they are bound to.
std::vector<MappedPlane> describe_planes(const Map& map);
/// The objects likewise.
std::vector<MappedObject> describe_objects(const Map& map);

/// Multiplies all lengths of a result in units of the map by its scale.
void to_metres(SlamResult& result);
/// How far keypoints lie from where the map's points project, over all observations of a map.
ReprojectionError reprojection_error(const Map& map);

}  // namespace cairn
