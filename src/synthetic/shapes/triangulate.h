#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/synthetic/shapes/curve.h"

namespace cairn {

/// Cuts a simple polygon into counter-clockwise triangles of its points by clipping ears (Meisters
/// 1975). Quadratic or worse; meant for outlines of up to some hundred points.
std::vector<Eigen::Vector3i> triangulate(const Outline& outline);

}  // namespace cairn
