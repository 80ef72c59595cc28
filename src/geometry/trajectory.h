#pragma once

#include <vector>

#include "cairn/geometry/se3.h"

namespace cairn {

/// A camera pose (camera to world) at a time in seconds.
struct StampedPose {
  double timestamp = 0;
  SE3 T_wc;
};

/// Poses in order of time.
using Trajectory = std::vector<StampedPose>;

}  // namespace cairn
