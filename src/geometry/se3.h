#pragma once

// The geometry room: transforms, cameras, two-view geometry, resection, triangulation, ellipsoids,
// assignment. Pure functions of numbers; it knows no pictures, no maps, no files.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cairn {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Skew-symmetric matrix: skew(a) * b = a × b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation vector (radians) to unit quaternion and back; both are stable near zero.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& omega);
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);

/// Rigid transform. Named by what it does: `T_cw * X_w = X_c`.
/// Tangent vectors are (rho, omega): translation in metres first, then rotation in radians.
class SE3 {
 public:
  SE3() : q_(Eigen::Quaterniond::Identity()), t_(Eigen::Vector3d::Zero()) {}
  SE3(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) : q_(q.normalized()), t_(t) {}
  SE3(const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
      : q_(Eigen::Quaterniond(R).normalized()), t_(t) {}

  const Eigen::Quaterniond& rotation() const { return q_; }
  const Eigen::Vector3d& translation() const { return t_; }
  Eigen::Matrix3d matrix3() const { return q_.toRotationMatrix(); }
  Eigen::Matrix4d matrix() const;

  SE3 inverse() const;
  SE3 operator*(const SE3& other) const { return SE3(q_ * other.q_, q_ * other.t_ + t_); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return q_ * x + t_; }

  /// exp: se(3) → SE(3), e.g. `T * SE3::exp(xi)` is the right-multiplied update (Barfoot, State
  /// Estimation for Robotics, ch. 8).
  static SE3 exp(const Vector6d& xi);
  Vector6d log() const;

  bool is_finite() const { return q_.coeffs().allFinite() && t_.allFinite(); }

 private:
  Eigen::Quaterniond q_;
  Eigen::Vector3d t_;
};

/// T · exp(ξ) · T⁻¹ = exp(adjoint(T) · ξ).
Eigen::Matrix<double, 6, 6> adjoint(const SE3& T);

}  // namespace cairn
