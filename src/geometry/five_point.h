#pragma once

#include <Eigen/Core>
#include <array>

namespace cairn {

/// The essential matrices, up to ten, that a minimal sample admits. Each has Frobenius norm 1.
struct EssentialCandidates {
  std::array<Eigen::Matrix3d, 10> matrices;
  int count = 0;
};

/// Nistér, "An efficient solution to the five-point relative pose problem" (PAMI 2004): all E with
/// x2ᵀ E x1 = 0 for five pairs of viewing rays (first and second camera frame, any scale).
/// Degenerate or non-finite input gives no or meaningless candidates, never a crash.
EssentialCandidates five_point(const std::array<Eigen::Vector3d, 5>& rays1,
                               const std::array<Eigen::Vector3d, 5>& rays2);

}  // namespace cairn
