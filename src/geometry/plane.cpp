#include "cairn/geometry/plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kMinNormal = 1e-6;  // of a unit π: nearer than a million units

// S³ is the group of unit quaternions: exp and log are theirs, with n as the vector part.
Quaterniond as_quaternion(const Vector4d& pi) { return Quaterniond(pi); }

}  // namespace

Plane::Plane(const Vector3d& normal, double offset) {
  pi_ << normal, offset;
  pi_.normalize();
  assert(is_finite());
}

std::optional<Plane> Plane::from_coefficients(const Vector4d& coefficients) {
  const double largest = coefficients.lpNorm<Eigen::Infinity>();
  if (!coefficients.allFinite() || !(largest > 0)) return std::nullopt;
  const Plane plane(Vector4d(coefficients / largest));  // squares neither overflow nor vanish
  return plane.is_finite() ? std::optional(plane) : std::nullopt;
}

bool Plane::is_finite() const { return pi_.allFinite() && pi_.head<3>().norm() > kMinNormal; }

Plane::Hessian Plane::hessian() const { return pi_ / std::max(pi_.head<3>().norm(), kMinNormal); }

Plane::Matrix43d Plane::hessian_by_step() const {
  const Hessian h = hessian();
  const Vector3d n = h.head<3>();
  const double d = h[3];
  Matrix43d J;
  J.topRows<3>() = d * (Matrix3d::Identity() - n * n.transpose()) - skew(n);
  J.row(3) = -(1 + d * d) * n.transpose();
  return J;
}

std::optional<double> Plane::depth_along(const Vector3d& ray) const {
  const Hessian h = hessian();
  const double along = h.head<3>().dot(ray);
  if (!(std::abs(along) > 1e-9 * ray.norm())) return std::nullopt;
  const double z = -h[3] / along;
  return z > 0 && std::isfinite(z) ? std::optional(z) : std::nullopt;
}

Eigen::Matrix4d Plane::transform(const SE3& T_ba) {
  const Matrix3d R = T_ba.matrix3();
  Eigen::Matrix4d M;
  M << R, Vector3d::Zero(), -T_ba.translation().transpose() * R, 1;
  return M;
}

Plane Plane::transformed(const SE3& T_ba) const {
  const Vector3d n = T_ba.rotation() * Vector3d(pi_.head<3>());
  return Plane(Vector4d(n.x(), n.y(), n.z(), pi_[3] - n.dot(T_ba.translation())));
}

Plane Plane::scaled(double s) const {
  assert(s > 0);
  return Plane(Vector4d(pi_[0], pi_[1], pi_[2], s * pi_[3]));
}

Plane Plane::exp(const Vector3d& step) const {
  return Plane(Vector4d((so3_exp(2 * step) * as_quaternion(pi_)).coeffs()));
}

Vector3d Plane::log(const Plane& other) const {
  return 0.5 * so3_log(as_quaternion(other.pi_) * as_quaternion(pi_).conjugate());
}

Plane::Matrix43d Plane::tangent() const {
  const Vector3d n = pi_.head<3>();
  Matrix43d B;
  B.topRows<3>() = pi_[3] * Matrix3d::Identity() - skew(n);
  B.row(3) = -n.transpose();
  return B;
}

double angle_between(const Plane& a, const Plane& b) {
  const Vector3d n = a.normal(), m = b.normal();
  return std::atan2(n.cross(m).norm(), std::abs(n.dot(m)));
}

Eigen::Matrix<double, 3, 2> tangent_axes(const Vector3d& n, Vector3d* spin) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  const Vector3d across = Vector3d::Unit(smallest).cross(n);
  const double length = across.norm();
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = across / length;
  axes.col(1) = n.cross(axes.col(0));
  if (spin != nullptr) *spin = axes.col(1).cross(Vector3d::Unit(smallest)) / length;
  return axes;
}

}  // namespace cairn
