#pragma once

#include <optional>
#include <vector>

#include "cairn/geometry/box.h"
#include "cairn/geometry/camera.h"
#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// Derivative of the edges (x0, y0, x1, y1) of a projected box by (ξ, δ), where the ellipsoid
/// becomes (T · exp(ξ), s · exp(δ)): 3 of translation, 3 of rotation, 3 of the log semi-axes.
using BoxByEllipsoid = Eigen::Matrix<double, 4, 9>;

/// The box around the ellipse that an ellipsoid, given in the camera's frame, shows in a pinhole
/// picture without borders: extrema of its dual conic C* = P Q* Pᵀ, x = (C13 ± √(C13² − C11 C33)) /
/// C33 and y likewise (Hartley and Zisserman, Multiple View Geometry, 8.3). None where the
/// ellipsoid is not wholly in front of the camera's plane. `derivative` may be null.
std::optional<Box2> projected_box(const Pinhole& pinhole, const Ellipsoid& in_camera,
                                  BoxByEllipsoid* derivative = nullptr);

/// `count` points on the ellipse, in order; empty where `projected_box` has none.
std::vector<Eigen::Vector2d> projected_outline(const Pinhole& pinhole, const Ellipsoid& in_camera,
                                               int count);

}  // namespace cairn
