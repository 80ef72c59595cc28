#pragma once

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// Where a shutter that opens for all rows at once sees what a rolling one saw at `pixel` of the
/// ideal pinhole (pixels).
///
/// `moment`: when its row was read, as a share of the time in which all are: −1/2 the first, 1/2
/// the last; 0 is the time of the picture. `motion`: tangent vector of the camera's motion, in its
/// own frame, while all rows are read (lengths in the unit of `depth`); it is taken as even.
/// `depth` of what is seen, along the optical axis; infinity where only rotation counts.
Eigen::Vector2d seen_at_once(const Pinhole& pinhole, const Eigen::Vector2d& pixel, double depth,
                             double moment, const Vector6d& motion);

}  // namespace cairn
