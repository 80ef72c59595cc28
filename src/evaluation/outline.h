#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cairn {

/// The centre of a planar polygon's area; that of its corners where it has none.
Eigen::Vector3d middle(std::span<const Eigen::Vector3d> outline);

double area(std::span<const Eigen::Vector3d> outline);

/// How far `x`, a point of the polygon's plane, is outside of the polygon; negative inside: how far
/// from its border.
double distance_outside(const Eigen::Vector3d& x, std::span<const Eigen::Vector3d> outline,
                        const Eigen::Vector3d& normal);

/// The same of a surface of several polygons in one plane: from the nearest of them.
double distance_outside(const Eigen::Vector3d& x,
                        std::span<const std::vector<Eigen::Vector3d>> surface,
                        const Eigen::Vector3d& normal);

/// Of the area of a polygon, projected along the unit `normal` into the plane of a surface, the
/// share that is on the surface or not farther than `margin` from it.
double share_on(std::span<const std::vector<Eigen::Vector3d>> surface,
                const Eigen::Vector3d& normal, std::span<const Eigen::Vector3d> polygon,
                double margin);

}  // namespace cairn
