#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "cairn/geometry/epipolar.h"

namespace cairn {

/// x2 ~ H x1 from four matches or more with a flag in `inliers`, by the normalised direct linear
/// transform (Hartley and Zisserman, algorithm 4.2). Frobenius norm 1; not finite where the points
/// coincide.
Eigen::Matrix3d fit_homography(std::span<const NormalizedMatch> matches,
                               std::span<const char> inliers);

/// The same from a minimal sample.
Eigen::Matrix3d fit_homography(const std::array<NormalizedMatch, 4>& matches);

/// Motions that a homography of the planes z = 1 admits.
struct HomographyMotions {
  std::array<SE3, 4> motions;  ///< |t| = 1
  int count = 0;               ///< 0 where the camera only turned: a plane's motion is not defined
};

/// Ma, Soatto, Kosecka and Sastry, "An Invitation to 3-D Vision", section 5.3.3: H ~ R + t nᵀ / d
/// has four solutions; (R, t) and (R, -t) differ in the side on which the plane lies.
HomographyMotions decompose_homography(const Eigen::Matrix3d& H);

}  // namespace cairn
