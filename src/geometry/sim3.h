#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string>

#include "cairn/geometry/se3.h"

namespace cairn {

using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Similarity transform x → s R x + t with s > 0. Named like SE3: `S_ba * X_a = X_b`.
/// Tangent vectors are (rho, omega, sigma): translation, rotation in radians, logarithm of scale.
class Sim3 {
 public:
  Sim3() : q_(Eigen::Quaterniond::Identity()), t_(Eigen::Vector3d::Zero()) {}
  Sim3(double scale, const Eigen::Quaterniond& q, const Eigen::Vector3d& t)
      : s_(scale), q_(q.normalized()), t_(t) {}
  Sim3(double scale, const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
      : s_(scale), q_(Eigen::Quaterniond(R).normalized()), t_(t) {}
  explicit Sim3(const SE3& T) : q_(T.rotation()), t_(T.translation()) {}

  double scale() const { return s_; }
  const Eigen::Quaterniond& rotation() const { return q_; }
  const Eigen::Vector3d& translation() const { return t_; }
  Eigen::Matrix3d matrix3() const { return q_.toRotationMatrix(); }
  Eigen::Matrix4d matrix() const;

  Sim3 inverse() const;
  Sim3 operator*(const Sim3& other) const {
    return Sim3(s_ * other.s_, q_ * other.q_, s_ * (q_ * other.t_) + t_);
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return s_ * (q_ * x) + t_; }

  /// The pose of a camera when its world is transformed: S_vw and T_wc give T_vc. The camera's own
  /// frame takes the new world's unit.
  SE3 move(const SE3& T_wc) const { return SE3(q_ * T_wc.rotation(), *this * T_wc.translation()); }

  /// exp: sim(3) → Sim(3); `S * Sim3::exp(xi)` is the right-multiplied update. The translation is
  /// the integral of exp(tau sigma) Exp(tau omega) rho over tau from 0 to 1.
  static Sim3 exp(const Vector7d& xi);
  Vector7d log() const;

  bool is_finite() const { return std::isfinite(s_) && q_.coeffs().allFinite() && t_.allFinite(); }

 private:
  double s_ = 1;
  Eigen::Quaterniond q_;
  Eigen::Vector3d t_;
};

struct SimilarityFit {
  bool usable = false;
  std::string refusal;  ///< a sentence for people where it is not usable
  Sim3 transform;       ///< `to` ≈ transform * `from`
  double rmse = 0;      ///< root mean square distance afterwards, units of `to`
};

/// The similarity (without scale: the rigid transform) that moves `from` onto `to` with the least
/// sum of squared distances; from[i] belongs to to[i]. Umeyama, "Least-squares estimation of
/// transformation parameters between two point patterns" (PAMI 1991). Refuses fewer than three
/// points, points in one place or on one line (their rotation is not defined), numbers that are not
/// finite. On one line is where the second singular value of the cross-covariance is less than
/// `min_flatness` of the first one.
SimilarityFit align_umeyama(std::span<const Eigen::Vector3d> from,
                            std::span<const Eigen::Vector3d> to, bool with_scale,
                            double min_flatness = 1e-12);

}  // namespace cairn
