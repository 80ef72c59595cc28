#pragma once

#include <Eigen/Core>
#include <optional>

#include "cairn/geometry/se3.h"

namespace cairn {

/// A plane {x : nᵀx + d = 0} as a homogeneous vector π = (n, d) of unit length, a point of the
/// sphere S³ (Kaess, "Simultaneous localization and mapping with infinite planes", ICRA 2015). π
/// and −π hold the same points; the sign says which side is the positive one.
///
/// Tangent vectors are arcs on S³ in radians: 3 numbers, so that one step of length a moves π by
/// the angle a. (Kaess, who counts as quaternions do, has twice these numbers.)
class Plane {
 public:
  using Hessian = Eigen::Vector4d;  ///< (unit normal, offset): offset in units of the map
  using Matrix43d = Eigen::Matrix<double, 4, 3>;

  /// z = 0, positive above.
  Plane() : pi_(0, 0, 1, 0) {}
  /// {x : normalᵀx + offset = 0}, the Hessian normal form where `normal` has unit length. Asserts
  /// that the numbers are a plane.
  Plane(const Eigen::Vector3d& normal, double offset);
  /// Any homogeneous vector, unchecked: for what was checked before.
  explicit Plane(const Eigen::Vector4d& pi) : pi_(pi.normalized()) {}
  /// Any homogeneous vector, of any length. None where it is not finite or almost the plane at
  /// infinity: farther than a million units from the origin.
  static std::optional<Plane> from_coefficients(const Eigen::Vector4d& coefficients);
  static Plane through(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    return Plane(normal, -normal.dot(point));
  }

  /// π, of unit length.
  const Eigen::Vector4d& coefficients() const { return pi_; }
  /// Of unit length, towards the positive side.
  Eigen::Vector3d normal() const { return hessian().head<3>(); }
  /// d for the unit normal, units of the map: the signed distance of the origin.
  double offset() const { return hessian()[3]; }
  /// (normal, offset). Always finite for a finite π, even at infinity.
  Hessian hessian() const;
  /// Of hessian() by a step on the sphere, where the step is zero.
  Matrix43d hessian_by_step() const;
  /// False if a number is not finite or the plane is almost at infinity; see from_coefficients().
  bool is_finite() const;

  double signed_distance(const Eigen::Vector3d& x) const {
    const Hessian h = hessian();
    return h.head<3>().dot(x) + h[3];
  }
  /// The depth z > 0 at which z · ray lies on the plane, for a viewing ray at depth 1
  /// (Pinhole::unproject). None along the plane and behind the camera.
  std::optional<double> depth_along(const Eigen::Vector3d& ray) const;

  /// This plane of frame a in frame b: T_ba^{-T} π.
  Plane transformed(const SE3& T_ba) const;
  /// T_ba^{-T}, which takes homogeneous planes and Hessian forms alike from a to b.
  static Eigen::Matrix4d transform(const SE3& T_ba);
  /// The plane where all lengths are multiplied by s > 0.
  Plane scaled(double s) const;
  /// The same points with the other side positive.
  Plane flipped() const {
    Plane other = *this;
    other.pi_ = -pi_;
    return other;
  }
  /// The side of the origin is positive: in a camera's frame the side that it sees.
  Plane facing_origin() const { return pi_[3] < 0 ? flipped() : *this; }

  /// exp: this plane moved by a step, `plane ⊞ step`.
  Plane exp(const Eigen::Vector3d& step) const;
  /// log: the shortest step from this plane to `other`, whichever its sign: `other ⊟ plane`, at
  /// most π/2 long.
  Eigen::Vector3d log(const Plane& other) const;
  /// Orthonormal columns: the directions in R⁴ that the three numbers of a step move π along.
  Matrix43d tangent() const;

 private:
  Eigen::Vector4d pi_;
};

/// Between the normals of two planes up to their sign: 0 to π/2 radians.
double angle_between(const Plane& a, const Plane& b);

/// Two orthonormal vectors t₁, t₂ with t₁ × t₂ = n for a unit vector n: axes of its tangent plane.
/// They jump where another coordinate of n becomes the smallest one. `spin`: between the jumps,
/// when n turns by dn, the axes turn about n by spinᵀ dn besides.
Eigen::Matrix<double, 3, 2> tangent_axes(const Eigen::Vector3d& n, Eigen::Vector3d* spin = nullptr);

}  // namespace cairn
