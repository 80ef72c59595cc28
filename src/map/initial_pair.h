#pragma once

#include <memory>
#include <vector>

#include "cairn/geometry/se3.h"
#include "cairn/map/frame.h"

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
};

}  // namespace cairn
