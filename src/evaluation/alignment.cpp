#include "cairn/evaluation/alignment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>

#include "cairn/geometry/error.h"
#include "cairn/geometry/sim3.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

// Tracks that are straight but for rounding are still judged: what is not determined about them,
// the rotation about the line, moves no position.
constexpr double kMinFlatness = 1e-14;

constexpr double kMostTurned = 0.1;  // radians, between what positions and orientations say

bool stands_still(std::span<const Vector3d> positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [&](const Vector3d& x) { return x == positions[0]; });
}

[[noreturn]] void refuse(const std::string& why) {
  throw Error(Error::Kind::kInput, "alignment: " + why);
}

}  // namespace

TrajectoryAlignment align_trajectory(std::span<const Vector3d> from, std::span<const Vector3d> to,
                                     Alignment alignment) {
  if (alignment == Alignment::kNone) return {};
  if (from.size() < 3) {
    refuse(std::to_string(from.size()) +
           " poses of the estimate have a ground truth, but three are needed; check the "
           "timestamps, --max-difference and --offset, or use --align none");
  }
  if (stands_still(from) || stands_still(to)) {
    refuse(std::string(stands_still(from) ? "the estimate" : "the ground truth") +
           " does not move, so that scale and rotation are not determined; use --align none");
  }
  const SimilarityFit fit = align_umeyama(from, to, alignment == Alignment::kSim3, kMinFlatness);
  if (!fit.usable) {
    refuse(fit.refusal +
           "; check that both trajectories are whole and of the same sequence, or use --align "
           "none");
  }
  return {SE3(fit.transform.rotation(), fit.transform.translation()), fit.transform.scale()};
}

TrajectoryAlignment align_views(const TrajectoryAlignment& of_positions, std::span<const SE3> from,
                                std::span<const SE3> to) {
  // The mean of rotations (Markley et al., 2007).
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  Vector3d from_mean = Vector3d::Zero(), to_mean = Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Quaterniond turn = to[i].rotation() * from[i].rotation().conjugate();
    sum += turn.coeffs() * turn.coeffs().transpose();
    from_mean += from[i].translation() / double(from.size());
    to_mean += to[i].translation() / double(from.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(sum);
  const Eigen::Quaterniond turn(Eigen::Vector4d(eigen.eigenvectors().col(3)));
  if (!(turn.angularDistance(of_positions.T.rotation()) < kMostTurned)) return of_positions;
  return {SE3(turn, to_mean - of_positions.scale * (turn * from_mean)), of_positions.scale};
}

}  // namespace cairn
