#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {

/// Groups of an adjustment's blocks, in the order of elimination. Within a group Ceres orders
/// blocks by their addresses: so each group is one piece of memory, reserved before it is filled,
/// or runs would differ.
enum BlockGroup : int {
  kPointGroup,
  kPoseGroup,
  kPlaneGroup,
  kObjectGroup,
  kHeldPoseGroup,
  kHeldPointGroup,
  kLensGroup,
  kScaleGroup,
};

/// The keyframes' poses as landmarks meet them in an adjustment: those of its own keyframes, and
/// those of others, which it holds where they are.
class PoseBlocks {
 public:
  /// Where an adjustment keeps a keyframe's pose; null: it does not.
  using Own = std::function<double*(KeyframeId)>;

  /// All of them must outlive it, and it the problem's use.
  PoseBlocks(const Map& map, ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering,
             Own own);
  PoseBlocks(const PoseBlocks&) = delete;
  PoseBlocks& operator=(const PoseBlocks&) = delete;

  /// Of the adjustment; null for other keyframes.
  double* own(KeyframeId id) const { return own_(id); }
  /// The adjustment's own, or one that is held.
  double* at(KeyframeId id);

 private:
  const Map& map_;
  ceres::Problem& problem_;
  ceres::ParameterBlockOrdering& ordering_;
  Own own_;
  std::vector<std::array<double, 7>> held_;
  std::vector<std::pair<KeyframeId, double*>> held_of_;
  SE3Manifold manifold_;
};

}  // namespace cairn
