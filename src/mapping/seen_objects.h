#pragma once

#include <span>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/map/frame.h"
#include "cairn/map/object_landmark.h"
#include "cairn/perception/detections.h"

namespace cairn {

/// Detections in a picture of `camera`, with its lens, as the ideal pinhole camera of `view` has
/// them: boxes around where the rays of their borders go. Boxes without area or with numbers that
/// are not finite are left out.
std::vector<SeenObject> see_objects(std::span<const DetectedObject> detected, const Frame& frame,
                                    const Camera& camera, const View& view);

}  // namespace cairn
