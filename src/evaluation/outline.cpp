#include "cairn/evaluation/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cairn/geometry/polygon.h"

namespace cairn {

using Eigen::Vector3d;

namespace {

double distance_to_segment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + t * ab - x).norm();
}

}  // namespace

// Triangles from the first corner, weighted by their signed areas.
Vector3d middle(std::span<const Vector3d> outline) {
  const Vector3d normal = twice_area(outline);
  if (!(normal.norm() > 1e-12)) {
    Vector3d corners = Vector3d::Zero();
    for (const Vector3d& corner : outline)
      corners += (corner - outline[0]) / double(outline.size());
    return outline[0] + corners;
  }
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const Vector3d a = outline[i] - outline[0], b = outline[i + 1] - outline[0];
    sum += a.cross(b).dot(normal) * (a + b) / 3;
  }
  return outline[0] + sum / normal.squaredNorm();
}

double area(std::span<const Vector3d> outline) { return twice_area(outline).norm() / 2; }

// Inside is where the corners wind around the point.
double distance_outside(const Vector3d& x, std::span<const Vector3d> outline,
                        const Vector3d& normal) {
  double winding = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector3d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    winding += std::atan2((a - x).cross(b - x).dot(normal), (a - x).dot(b - x));
    nearest = std::min(nearest, distance_to_segment(x, a, b));
  }
  return std::abs(winding) > M_PI ? -nearest : nearest;
}

double distance_outside(const Vector3d& x, std::span<const std::vector<Vector3d>> surface,
                        const Vector3d& normal) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::vector<Vector3d>& part : surface) {
    nearest = std::min(nearest, distance_outside(x, part, normal));
  }
  return nearest;
}

// A grid of points of the polygon is asked.
double share_on(std::span<const std::vector<Vector3d>> surface, const Vector3d& normal,
                std::span<const Vector3d> polygon, double margin) {
  constexpr int kPoints = 50;  // a side
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector3d foot = normal.dot(surface[0][0]) * normal;
  std::vector<Vector3d> flat;
  Eigen::AlignedBox2d box;
  for (const Vector3d& corner : polygon) {
    flat.push_back(corner - normal.dot(corner - foot) * normal);
    box.extend(Eigen::Vector2d(u.dot(corner), v.dot(corner)));
  }
  int all = 0, inside = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const Eigen::Array2d cell(i % kPoints + 0.5, int(i / kPoints) + 0.5);
    const Eigen::Vector2d at = box.min().array() + cell / kPoints * box.sizes().array();
    const Vector3d x = foot + at.x() * u + at.y() * v;
    if (distance_outside(x, flat, normal) > 0) continue;
    ++all;
    inside += distance_outside(x, surface, normal) <= margin;
  }
  return all == 0 ? 0 : double(inside) / all;
}

}  // namespace cairn
