#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cairn {

/// A closed curve in the plane, counter-clockwise, without the first point again at the end.
using Outline = std::vector<Eigen::Vector2f>;
/// A curve in space, from its first point to its last.
using Path = std::vector<Eigen::Vector3f>;

Outline circle(float radius, int points);
Outline ellipse(float a, float b, int points);
/// A rectangle around the origin whose corners are arcs of `steps` pieces.
Outline rounded_rectangle(float size_x, float size_y, float radius, int steps = 3);
/// The outline with every edge moved inwards by `distance` (outwards where negative).
Outline inset(const Outline& outline, float distance);

/// A smooth curve through all points (Catmull-Rom, 1974), `steps` pieces between two of them.
Path smooth(const Path& points, int steps);
std::vector<Eigen::Vector2f> smooth(std::span<const Eigen::Vector2f> points, int steps);

/// The points of the polyline with each inner corner replaced by an arc that starts at most
/// `radius` away from the corner.
Path round_corners(const Path& points, float radius, int steps = 4);

/// `count` numbers from `from` to `to`, both included.
std::vector<float> evenly(float from, float to, int count);

}  // namespace cairn
