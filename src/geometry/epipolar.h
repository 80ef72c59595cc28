#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "cairn/geometry/se3.h"

namespace cairn {

/// A match on the planes z = 1 of two cameras, without units: (x1, y1, x2, y2).
using NormalizedMatch = Eigen::Vector4d;

/// E = [t]x R, so that x2ᵀ E x1 = 0.
Eigen::Matrix3d essential_matrix(const SE3& T_21);

/// The four motions with |t| = 1 that share an essential matrix: (R, ±t) and the twisted pair
/// (Hartley and Zisserman, section 9.6.2).
std::array<SE3, 4> decompose_essential(const Eigen::Matrix3d& E);

/// Refines R and the direction of t (5 degrees of freedom) on the Sampson errors of the matches
/// with a flag in `inliers`, by Levenberg-Marquardt with Huber weights. `px` is (fx, fy) divided by
/// the measurement's sigma in pixels: errors are counted in sigmas.
SE3 refine_motion(const SE3& T_21, std::span<const NormalizedMatch> matches,
                  std::span<const char> inliers, const Eigen::Vector2d& px, int iterations);

}  // namespace cairn
