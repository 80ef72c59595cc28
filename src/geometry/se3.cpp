#include "cairn/geometry/se3.h"

namespace cairn {
namespace {

constexpr double kSmallAngle = 1e-5;

// Left Jacobian of SO(3), V(omega) with exp(rho, omega) = (Exp(omega), V(omega) rho).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& omega) {
  const double theta2 = omega.squaredNorm();
  const Eigen::Matrix3d W = skew(omega);
  if (theta2 < kSmallAngle * kSmallAngle) {
    return Eigen::Matrix3d::Identity() + 0.5 * W + W * W / 6.0;
  }
  // 1 - cos(theta) as 2 sin²(theta / 2): it keeps its digits at small angles.
  const double theta = std::sqrt(theta2), half_sine = std::sin(0.5 * theta);
  return Eigen::Matrix3d::Identity() + 2.0 * half_sine * half_sine / theta2 * W +
         (theta - std::sin(theta)) / (theta2 * theta) * W * W;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

Eigen::Quaterniond so3_exp(const Eigen::Vector3d& omega) {
  const double theta = omega.norm();
  const double half = 0.5 * theta;
  const double k = theta < kSmallAngle ? 0.5 - theta * theta / 48.0 : std::sin(half) / theta;
  return Eigen::Quaterniond(std::cos(half), k * omega.x(), k * omega.y(), k * omega.z())
      .normalized();
}

Eigen::Vector3d so3_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d v = sign * q.vec();
  const double w = sign * q.w();
  const double n = v.norm();
  if (n < kSmallAngle) return 2.0 / w * (1.0 - n * n / (3.0 * w * w)) * v;
  return 2.0 * std::atan2(n, w) / n * v;
}

Eigen::Matrix4d SE3::matrix() const {
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  M.topLeftCorner<3, 3>() = matrix3();
  M.topRightCorner<3, 1>() = t_;
  return M;
}

SE3 SE3::inverse() const {
  const Eigen::Quaterniond qi = q_.conjugate();
  return SE3(qi, -(qi * t_));
}

SE3 SE3::exp(const Vector6d& xi) {
  const Eigen::Vector3d omega = xi.tail<3>();
  return SE3(so3_exp(omega), left_jacobian(omega) * xi.head<3>());
}

Vector6d SE3::log() const {
  Vector6d xi;
  const Eigen::Vector3d omega = so3_log(q_);
  xi.tail<3>() = omega;
  xi.head<3>() = left_jacobian(omega).inverse() * t_;
  return xi;
}

Eigen::Matrix<double, 6, 6> adjoint(const SE3& T) {
  const Eigen::Matrix3d R = T.matrix3();
  Eigen::Matrix<double, 6, 6> A;
  A << R, skew(T.translation()) * R, Eigen::Matrix3d::Zero(), R;
  return A;
}

}  // namespace cairn
