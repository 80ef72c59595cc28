#pragma once

#include <Eigen/Core>
#include <span>

#include "cairn/geometry/se3.h"

namespace cairn {

enum class Alignment {
  kSim3,  ///< rotation, translation and scale: monocular maps
  kSE3,   ///< rotation and translation
  kNone,  ///< as they are
};

/// What takes the estimate into the frame of the truth: `x_truth = R (scale · x) + t`, T = (R, t).
struct TrajectoryAlignment {
  SE3 T;
  double scale = 1;

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return T * (scale * x); }
  /// Camera to the estimate's world, into camera to the world of the truth.
  SE3 operator*(const SE3& T_wc) const {
    return T * SE3(T_wc.rotation(), scale * T_wc.translation());
  }
};

/// The least-squares alignment of `from` to `to` (Umeyama, PAMI 1991). Throws Error(kInput), with
/// the reason, if it is not determined: less than three pairs, points that all lie on one line or
/// in one place, values that are not finite. `kNone` is always possible.
TrajectoryAlignment align_trajectory(std::span<const Eigen::Vector3d> from,
                                     std::span<const Eigen::Vector3d> to, Alignment alignment);

/// The alignment for what the cameras see: turned as their orientations say, with the scale of
/// `of_positions`. A short path does not say how it is turned: 30 cm with errors of 4 mm are off by
/// a degree, and with them all that stands two metres away. `of_positions` itself where
/// orientations and positions disagree by more than noise can: then the two mean different cameras.
TrajectoryAlignment align_views(const TrajectoryAlignment& of_positions, std::span<const SE3> from,
                                std::span<const SE3> to);

}  // namespace cairn
