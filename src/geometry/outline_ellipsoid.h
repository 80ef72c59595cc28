#pragma once

#include <optional>
#include <vector>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// The ellipsoid that has a thing's outlines: from far away, in every direction, it ends where the
/// thing ends, as nearly as an ellipsoid can (least squares of max n·x over the points and
/// n·c + |diag(s) Rᵀ n| over directions n). Boxes in pictures say this of a thing; the ellipsoid
/// that encloses it is larger, for a cube by √3 : 1.5 on every axis. None for fewer than four
/// points, and for points of one plane.
std::optional<Ellipsoid> outline_ellipsoid(const std::vector<Eigen::Vector3d>& points);

}  // namespace cairn
