#pragma once

#include <memory>
#include <vector>

#include "cairn/geometry/se3.h"
#include "cairn/map/frame.h"
#include "cairn/map/point_patch.h"

namespace cairn {

/// Two frames that show the world from two places, and the points between them.
struct InitialPair {
  struct Point {
    std::uint32_t keypoint1, keypoint2;
    Eigen::Vector3d position;  ///< in the first camera; |t_21| = 1
  };
  std::shared_ptr<const Frame> frame1, frame2;
  SE3 T_21;
  std::vector<Point> points;
  std::shared_ptr<const Picture> picture1 = {}, picture2 = {};  ///< if points are to be aligned
};

}  // namespace cairn
