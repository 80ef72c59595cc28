#pragma once

#include <Eigen/Core>
#include <span>

namespace cairn {

/// The centre of a planar polygon's area; that of its corners where it has none.
Eigen::Vector3d middle(std::span<const Eigen::Vector3d> outline);

/// How far `x`, a point of the polygon's plane, is outside of the polygon; 0 inside.
double distance_outside(const Eigen::Vector3d& x, std::span<const Eigen::Vector3d> outline,
                        const Eigen::Vector3d& normal);

}  // namespace cairn
