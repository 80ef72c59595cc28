#pragma once

#include <Eigen/Core>
#include <span>

namespace cairn {

/// The centre of a planar polygon's area; that of its corners where it has none.
Eigen::Vector3d middle(std::span<const Eigen::Vector3d> outline);

double area(std::span<const Eigen::Vector3d> outline);

/// How far `x`, a point of the polygon's plane, is outside of the polygon; negative inside: how far
/// from its border.
double distance_outside(const Eigen::Vector3d& x, std::span<const Eigen::Vector3d> outline,
                        const Eigen::Vector3d& normal);

/// Of the area of a polygon, projected along the unit `normal` into the other's plane, the share
/// that is inside of the other or not farther than `margin` from it.
double share_inside(std::span<const Eigen::Vector3d> polygon,
                    std::span<const Eigen::Vector3d> other, const Eigen::Vector3d& normal,
                    double margin);

}  // namespace cairn
