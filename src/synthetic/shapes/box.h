#pragma once

#include "cairn/synthetic/mesh.h"

namespace cairn {

struct BoxOptions {
  float radius = 0;  ///< of its edges, metres; half the smallest side at most
  int steps = 1;     ///< pieces that make an eighth of a turn of an edge
  float cell = 0;    ///< longest side of the cells that faces are cut into; 0: one cell
};

/// A box that stands on z = 0 around the z axis. Each face has texture coordinates of its own:
/// (0, 0) in its left upper corner seen from outside (faces up and down: as read by someone who
/// stands in front of it at +x).
Mesh box(const Eigen::Vector3f& size, const BoxOptions& options = {});

/// The same, but with a top of another size (x, y): keys, shades, tapering legs.
Mesh tapered_box(const Eigen::Vector2f& base, const Eigen::Vector2f& top, float height);

/// A soft box: rounded all around, its large faces bulge by `bulge` metres.
Mesh cushion(const Eigen::Vector3f& size, float radius, float bulge);

}  // namespace cairn
