#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

namespace cairn {

/// Points `centre + R(rotation) diag(semi_axes) x`, |x| <= 1.
struct EnclosingEllipsoid {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< its axes to the points' frame
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Ones();

  /// At most one for what is inside or on it.
  double level(const Eigen::Vector3d& X) const {
    return (rotation.conjugate() * (X - centre)).cwiseQuotient(semi_axes).squaredNorm();
  }
};

/// The ellipsoid of least volume that encloses all points, by Khachiyan's algorithm with away steps
/// (Todd and Yildirim 2007). Its volume is at most (1 + `tolerance`)^1.5 times the least one, and
/// no point is outside by more than rounding. Of the ways to name its axes the one nearest to the
/// points' own axes is taken. None if the points do not span space.
std::optional<EnclosingEllipsoid> minimum_enclosing_ellipsoid(
    std::span<const Eigen::Vector3d> points, double tolerance = 1e-3);

}  // namespace cairn
