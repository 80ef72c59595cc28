#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cairn {

/// Twice the area of a planar polygon, along its normal: towards where its corners run
/// counter-clockwise.
Eigen::Vector3d twice_area(std::span<const Eigen::Vector3d> polygon);

/// Cuts a simple polygon, corners counter-clockwise, into counter-clockwise triangles of its
/// corners by clipping ears (Meisters 1975). Quadratic or worse; meant for outlines of up to some
/// hundred points.
std::vector<Eigen::Vector3i> polygon_triangles(std::span<const Eigen::Vector2f> polygon);

}  // namespace cairn
