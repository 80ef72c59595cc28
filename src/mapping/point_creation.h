#pragma once

#include <vector>

#include "cairn/map/map.h"

namespace cairn {

struct PointCreationOptions {
  int neighbours = 20;
  double min_parallax_deg = 1.0;
  double ratio = 0.8;  ///< nearest over second nearest descriptor near to the epipolar line, below
};

/// New points between the free keypoints of a keyframe and those of its covisible neighbours: matched
/// by descriptor along the epipolar line, triangulated, and kept where both pictures agree with the
/// point and with its size. Returns the new points.
std::vector<PointId> create_points(Map& map, KeyframeId keyframe,
                                   const PointCreationOptions& options);

}  // namespace cairn
