#include "cairn/optimization/pose_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kGate = 5.991;   // χ², 2 degrees of freedom, 95 %
constexpr double kPlaneGate = 2;  // σ
constexpr double kMinDepth = 1e-6;
constexpr int kRounds = 4;
constexpr int kIterations = 6;

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  int used = 0;
};

// Weighted residual of one observation in σ; false where the point is not in front of the camera.
bool residual(const PoseObservation& o, const Pinhole& K, const Eigen::Matrix3d& R_cw,
              const Eigen::Vector3d& t_cw, Eigen::Vector3d& X_c, Eigen::Vector2d& e) {
  X_c = R_cw * o.position + t_cw;
  if (!(X_c.z() > kMinDepth)) return false;
  e = (K.project(X_c) - o.pixel) / o.sigma;
  return e.allFinite();
}

NormalEquations linearise(std::span<const PoseObservation> observations, const Pinhole& K,
                          const SE3& T_cw, const std::vector<char>& inlier, bool robust) {
  NormalEquations n;
  const Eigen::Matrix3d R = T_cw.matrix3();
  const double delta = std::sqrt(kGate);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!inlier[i]) continue;
    Eigen::Vector3d X;
    Eigen::Vector2d e;
    if (!residual(observations[i], K, R, T_cw.translation(), X, e)) continue;
    const double norm = e.norm();
    const double w = robust && norm > delta ? delta / norm : 1.0;
    // T_wc · exp(ξ) moves the point in the camera by -ρ + [X]× ω.
    const double zi = 1.0 / X.z(), s = 1.0 / observations[i].sigma;
    const double fx = K.fx * zi * s, fy = K.fy * zi * s;
    const double x = X.x() * zi, y = X.y() * zi;
    Eigen::Matrix<double, 2, 6> J;
    J << -fx, 0, fx * x, fx * x * X.y(), -fx * (X.z() + x * X.x()), fx * X.y(),  //
        0, -fy, fy * y, fy * (X.z() + y * X.y()), -fy * y * X.x(), -fy * X.x();
    n.H.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose(), w);
    n.g.noalias() += w * (J.transpose() * e);
    ++n.used;
  }
  n.H = n.H.selfadjointView<Eigen::Lower>();
  return n;
}

// Planes that are seen and the motion that is expected hold the pose.
void add_support(const PoseSupport& support, const SE3& T_wc, NormalEquations& n) {
  double pose[7];
  SE3Manifold::pack(T_wc, pose);
  const double* blocks[] = {pose};
  for (const FixedPlaneObservationFactor& plane : support.planes) {
    Eigen::Vector3d e;
    Eigen::Matrix<double, 3, 7, Eigen::RowMajor> J;
    double* jacobians[] = {J.data()};
    plane.Evaluate(blocks, e.data(), jacobians);
    const double norm = e.norm();
    const double w = norm > kPlaneGate ? kPlaneGate / norm : 1.0;
    n.H += w * J.leftCols<6>().transpose() * J.leftCols<6>();
    n.g += w * J.leftCols<6>().transpose() * e;
  }
  const Vector6d information = support.prior.sigma.cwiseAbs2().cwiseInverse();
  n.H.diagonal() += information;
  n.g += information.cwiseProduct((support.prior.T_wc.inverse() * T_wc).log());
}

}  // namespace

PoseAdjustmentSummary adjust_pose(std::span<const PoseObservation> observations,
                                  const Pinhole& pinhole, SE3& T_wc, std::vector<char>& inlier,
                                  const PoseSupport* support) {
  const int least = support != nullptr ? 0 : 3;
  inlier.assign(observations.size(), 1);
  PoseAdjustmentSummary summary;
  SE3 pose = T_wc;
  const auto refuse = [&] {
    inlier.assign(observations.size(), 0);
    return PoseAdjustmentSummary{};
  };
  for (int round = 0; round < kRounds; ++round) {
    const bool robust = round < kRounds - 1;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      NormalEquations n = linearise(observations, pinhole, pose.inverse(), inlier, robust);
      if (n.used < least) return refuse();
      if (support != nullptr) add_support(*support, pose, n);
      const Vector6d step = n.H.ldlt().solve(-n.g);
      if (!step.allFinite()) return refuse();
      pose = pose * SE3::exp(step);
      if (step.tail<3>().norm() < 1e-7 && step.head<3>().norm() < 1e-8) break;
    }
    const SE3 T_cw = pose.inverse();
    const Eigen::Matrix3d R = T_cw.matrix3();
    summary.inliers = 0;
    double sum = 0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      Eigen::Vector3d X;
      Eigen::Vector2d e;
      inlier[i] = residual(observations[i], pinhole, R, T_cw.translation(), X, e) &&
                  e.squaredNorm() < kGate;
      if (inlier[i]) {
        ++summary.inliers;
        sum += e.squaredNorm();
      }
    }
    if (summary.inliers < least) return refuse();
    summary.rms = std::sqrt(sum / std::max(summary.inliers, 1));
  }
  if (!pose.is_finite()) return refuse();
  summary.usable = true;
  T_wc = pose;
  return summary;
}

}  // namespace cairn
