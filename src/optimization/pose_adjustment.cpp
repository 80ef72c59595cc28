#include "cairn/optimization/pose_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Vector12d = Eigen::Matrix<double, 12, 1>;

constexpr double kGate = 5.991;   // χ², 2 degrees of freedom, 95 %
constexpr double kPlaneGate = 2;  // σ
constexpr double kMinDepth = 1e-6;
constexpr int kRounds = 4;
constexpr int kIterations = 6;
// By how much the velocity while a picture is read differs from that between frames, in radians and
// in depths of the scene a second: a hand's tremor, 1 to 2 radians a second², over a frame.
constexpr double kTremor = 0.05;

// Of the step of the pose, and behind it the one of the motion.
struct NormalEquations {
  Matrix12d H = Matrix12d::Zero();
  Vector12d g = Vector12d::Zero();
  int used = 0;
};

// Weighted residual of one observation in σ, and its derivative by the step ξ of T_wc · exp(ξ),
// which moves the point in the camera by -ρ + [X]× ω.
struct Residual {
  Eigen::Vector2d e;
  Eigen::Matrix<double, 2, 6> J;
};

// What an adjustment looks for.
struct Estimate {
  SE3 T_wc;
  Vector6d motion = Vector6d::Zero();  // beyond what was expected
};

class Observer {
 public:
  Observer(const Pinhole& pinhole, const Estimate& estimate)
      : pinhole_(pinhole), motion_(estimate.motion) {
    const SE3 T_cw = estimate.T_wc.inverse();
    R_ = T_cw.matrix3();
    t_ = T_cw.translation();
  }

  // False where the point is not in front of the camera.
  bool operator()(const PoseObservation& o, Residual& r) const {
    const Eigen::Vector3d X = R_ * o.position + t_;
    if (!(X.z() > kMinDepth)) return false;
    const double zi = 1.0 / X.z(), s = 1.0 / o.sigma;
    const double fx = pinhole_.fx * zi * s, fy = pinhole_.fy * zi * s;
    const double x = X.x() * zi, y = X.y() * zi;
    r.J << -fx, 0, fx * x, fx * x * X.y(), -fx * (X.z() + x * X.x()), fx * X.y(),  //
        0, -fy, fy * y, fy * (X.z() + y * X.y()), -fy * y * X.x(), -fy * X.x();
    // When its row was read the camera was a step of moment · motion from where it is.
    r.e = (pinhole_.project(X) - o.pixel) / o.sigma + o.moment * (r.J * motion_);
    return r.e.allFinite();
  }

 private:
  const Pinhole& pinhole_;
  const Vector6d& motion_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d t_;
};

NormalEquations linearise(std::span<const PoseObservation> observations, const Observer& observer,
                          const std::vector<char>& inlier, bool robust, bool with_motion) {
  NormalEquations n;
  const double delta = std::sqrt(kGate);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Residual r;
    if (!inlier[i] || !observer(observations[i], r)) continue;
    const double norm = r.e.norm();
    const double w = robust && norm > delta ? delta / norm : 1.0;
    const Matrix6d H = w * (r.J.transpose() * r.J);
    const Vector6d g = w * (r.J.transpose() * r.e);
    n.H.topLeftCorner<6, 6>() += H;
    n.g.head<6>() += g;
    if (with_motion) {
      const double t = observations[i].moment;
      n.H.bottomLeftCorner<6, 6>() += t * H;
      n.H.bottomRightCorner<6, 6>() += t * t * H;
      n.g.tail<6>() += t * g;
    }
    ++n.used;
  }
  n.H.topRightCorner<6, 6>() = n.H.bottomLeftCorner<6, 6>().transpose();
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
    n.H.topLeftCorner<6, 6>() += w * J.leftCols<6>().transpose() * J.leftCols<6>();
    n.g.head<6>() += w * J.leftCols<6>().transpose() * e;
  }
  const Vector6d information = support.prior.sigma.cwiseAbs2().cwiseInverse();
  n.H.diagonal().head<6>() += information;
  n.g.head<6>() += information.cwiseProduct((support.prior.T_wc.inverse() * T_wc).log());
}

// False where there is none.
bool step(NormalEquations& n, const ShutterMotion* shutter, Estimate& estimate, Vector6d& xi) {
  if (shutter == nullptr) {
    xi = n.H.topLeftCorner<6, 6>().ldlt().solve(-n.g.head<6>());
    if (!xi.allFinite()) return false;
  } else {
    const Vector6d information = shutter->sigma.cwiseAbs2().cwiseInverse();
    n.H.diagonal().tail<6>() += information;
    n.g.tail<6>() += information.cwiseProduct(estimate.motion);
    const Vector12d both = n.H.ldlt().solve(-n.g);
    if (!both.allFinite()) return false;
    xi = both.head<6>();
    estimate.motion += both.tail<6>();
  }
  estimate.T_wc = estimate.T_wc * SE3::exp(xi);
  return true;
}

}  // namespace

ShutterMotion expected_motion(double readout, const Vector6d& velocity, double depth) {
  ShutterMotion shutter{readout * velocity, Vector6d::Constant(std::abs(readout) * kTremor)};
  shutter.sigma.head<3>() *= depth;
  return shutter;
}

PoseAdjustmentSummary adjust_pose(std::span<const PoseObservation> observations,
                                  const Pinhole& pinhole, SE3& T_wc, std::vector<char>& inlier,
                                  const PoseSupport* support, ShutterMotion* shutter) {
  const int least = support != nullptr ? 0 : 3;
  inlier.assign(observations.size(), 1);
  PoseAdjustmentSummary summary;
  Estimate estimate{T_wc};
  const auto refuse = [&] {
    inlier.assign(observations.size(), 0);
    return PoseAdjustmentSummary{};
  };
  for (int round = 0; round < kRounds; ++round) {
    const bool robust = round < kRounds - 1;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      NormalEquations n =
          linearise(observations, Observer(pinhole, estimate), inlier, robust, shutter != nullptr);
      if (n.used < least) return refuse();
      if (support != nullptr) add_support(*support, estimate.T_wc, n);
      Vector6d xi;
      if (!step(n, shutter, estimate, xi)) return refuse();
      if (xi.tail<3>().norm() < 1e-7 && xi.head<3>().norm() < 1e-8) break;
    }
    const Observer observer(pinhole, estimate);
    summary.inliers = 0;
    double sum = 0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      Residual r;
      inlier[i] = observer(observations[i], r) && r.e.squaredNorm() < kGate;
      if (inlier[i]) {
        ++summary.inliers;
        sum += r.e.squaredNorm();
      }
    }
    if (summary.inliers < least) return refuse();
    summary.rms = std::sqrt(sum / std::max(summary.inliers, 1));
  }
  if (!estimate.T_wc.is_finite()) return refuse();
  summary.usable = true;
  T_wc = estimate.T_wc;
  if (shutter != nullptr) shutter->motion += estimate.motion;
  return summary;
}

}  // namespace cairn
