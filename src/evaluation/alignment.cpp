#include "cairn/evaluation/alignment.h"

#include <Eigen/SVD>
#include <string>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Of the covariance's largest singular value: below, the rotation about the line is noise.
constexpr double kDegenerate = 1e-14;

Vector3d mean(std::span<const Vector3d> points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& x : points) sum += x;
  return sum / double(points.size());
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
  const Vector3d mean_from = mean(from), mean_to = mean(to);
  Matrix3d covariance = Matrix3d::Zero();
  double variance = 0, variance_to = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector3d a = from[i] - mean_from, b = to[i] - mean_to;
    covariance += b * a.transpose();
    variance += a.squaredNorm();
    variance_to += b.squaredNorm();
  }
  if (!covariance.allFinite()) refuse("a position is not finite; mend the trajectory files");
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d singular = svd.singularValues();
  if (variance == 0 || variance_to == 0) {
    refuse(std::string(variance == 0 ? "the estimate" : "the ground truth") +
           " does not move, so that scale and rotation are not determined; use --align none");
  }
  if (!(singular(1) > kDegenerate * singular(0))) {
    refuse(
        "all positions lie on one line, so that the rotation about it is not determined; use "
        "--align none or a sequence that turns");
  }
  Vector3d sign = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  const Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  TrajectoryAlignment result;
  if (alignment == Alignment::kSim3) result.scale = singular.dot(sign) / variance;
  if (!(result.scale > 0)) {
    refuse(
        "the estimate has nothing in common with the ground truth (its best scale is not "
        "positive); check that both are of the same sequence");
  }
  result.T = SE3(R, mean_to - result.scale * (R * mean_from));
  return result;
}

}  // namespace cairn
