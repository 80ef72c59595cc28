#pragma once

// The optimization room: factors and the problems made of them. It changes poses and landmarks, and
// decides neither which of them to change nor what belongs to what.

#include <span>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// A known point seen at a pixel.
struct PoseObservation {
  Eigen::Vector3d position;  ///< world
  Eigen::Vector2d pixel;     ///< of the ideal pinhole
  double sigma = 1;          ///< pixels
};

struct PoseAdjustmentSummary {
  bool usable = false;  ///< converged to a finite pose with at least three inliers
  int inliers = 0;
  double rms = 0;  ///< of the inliers, in σ
};

/// Motion-only adjustment: the camera pose alone, from points held fixed. Gauss-Newton on se(3)
/// with Huber weights, in rounds; after each round observations beyond the 95 % gate of their χ²
/// (5.99 at 2 degrees of freedom) are set aside, and come back if they agree later.
/// `T_wc` is start and result; `inlier` gets one entry an observation.
PoseAdjustmentSummary adjust_pose(std::span<const PoseObservation> observations,
                                  const Pinhole& pinhole, SE3& T_wc, std::vector<char>& inlier);

}  // namespace cairn
