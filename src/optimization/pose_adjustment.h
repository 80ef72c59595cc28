#pragma once

// The optimization room: factors and the problems made of them. It changes poses and landmarks, and
// decides neither which of them to change nor what belongs to what.

#include <deque>
#include <span>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"
#include "cairn/optimization/factors/plane_observation_factor.h"

namespace cairn {

/// A known point seen at a pixel.
struct PoseObservation {
  Eigen::Vector3d position;  ///< world
  Eigen::Vector2d pixel;     ///< of the ideal pinhole, where an instant shutter sees it
  double sigma = 1;          ///< pixels
  double moment = 0;         ///< when its row was read (see seen_at_once)
};

struct PoseAdjustmentSummary {
  bool usable = false;  ///< converged to a finite pose with at least three inliers
  int inliers = 0;
  double rms = 0;  ///< of the inliers, in σ
};

/// Where the camera is expected, and how surely: σ of a step T_wc · exp(ξ), translation first.
struct PosePrior {
  SE3 T_wc;
  Vector6d sigma = Vector6d::Ones();
};

/// What holds a pose beside its points: the motion so far, and planes where points are few.
struct PoseSupport {
  std::deque<FixedPlaneObservationFactor> planes;  ///< robust: 2 σ and more count linearly
  PosePrior prior;
};

/// How the camera moves while a rolling shutter reads its rows (see seen_at_once).
struct ShutterMotion {
  Vector6d motion = Vector6d::Zero();  ///< what is expected, which the pixels are for; then found
  Vector6d sigma = Vector6d::Ones();   ///< of what is expected
};

/// What to expect of a camera that moves at `velocity` (tangent vector a second) from frame to
/// frame, at `depth` from what it sees. While one picture is read, a hand moves otherwise.
ShutterMotion expected_motion(double readout, const Vector6d& velocity, double depth);

/// Motion-only adjustment: the camera pose alone, from points held fixed. Gauss-Newton on se(3)
/// with Huber weights, in rounds; after each round observations beyond the 95 % gate of their χ²
/// (5.99 at 2 degrees of freedom) are set aside, and come back if they agree later.
/// `T_wc` is start and result; `inlier` gets one entry an observation. With `support` even a pose
/// that no point agrees with is usable. With `shutter` the motion is estimated, too.
PoseAdjustmentSummary adjust_pose(std::span<const PoseObservation> observations,
                                  const Pinhole& pinhole, SE3& T_wc, std::vector<char>& inlier,
                                  const PoseSupport* support = nullptr,
                                  ShutterMotion* shutter = nullptr);

}  // namespace cairn
