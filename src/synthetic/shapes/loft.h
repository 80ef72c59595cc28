#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cairn/synthetic/mesh.h"
#include "cairn/synthetic/shapes/curve.h"

namespace cairn {

/// A closed curve in space: one cross-section of a body.
using Ring = std::vector<Eigen::Vector3f>;

/// A body through cross-sections of equally many points, with flat ends. Rings run
/// counter-clockwise as seen from where the body goes to. Texture: u around (from the first point,
/// at the longest ring's length), v along, from the last ring back to the first; ends as
/// print_from_above would. `material`, where given, says of what the cell after a ring and a point
/// of it is made (ends: 0).
Mesh loft(std::span<const Ring> rings, float crease_deg = 40,
          const std::function<std::uint32_t(int ring, int point)>& material = {});

/// A plane outline moved along a path, scaled by `scales` (one a point of the path; empty: 1). The
/// outline's x lies along `side` at the start, and turns as little as the path allows.
Mesh sweep(const Path& path, const Outline& outline, std::span<const float> scales = {},
           const Eigen::Vector3f& side = Eigen::Vector3f::UnitY(), float crease_deg = 40);

/// A round rod along a path. A path that ends where it starts is made a ring.
Mesh tube(const Path& path, float radius, int sides = 8);

/// A prism over an outline, from z = 0 to `height`, its edges bevelled. Ends have texture
/// coordinates from the outline's corner of least x and y, as read by someone in front (+x).
Mesh extrude(const Outline& outline, float height, float bevel = 0, float crease_deg = 40);

}  // namespace cairn
