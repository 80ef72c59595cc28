#pragma once

#include <ceres/problem.h>

#include <deque>
#include <utility>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/factors/odometry_factor.h"
#include "cairn/optimization/pose_blocks.h"

namespace cairn {

/// How keyframes lie that follow each other, as the map has them when this is made
/// (docs/factors/odometry.md).
class OdometryBlocks {
 public:
  explicit OdometryBlocks(const Map& map);

  /// `pose_of`: every keyframe of the map. What it adds to the problem is its own, and must outlive
  /// the problem's use.
  void add_to(ceres::Problem& problem, const PoseBlocks::Own& pose_of);

 private:
  std::vector<std::pair<KeyframeId, KeyframeId>> steps_;
  std::deque<OdometryFactor> factors_;  // one a step
};

}  // namespace cairn
