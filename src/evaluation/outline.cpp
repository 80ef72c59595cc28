#include "cairn/evaluation/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
  Vector3d normal = Vector3d::Zero(), corners = Vector3d::Zero();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector3d a = outline[i] - outline[0];
    normal += a.cross(outline[(i + 1) % outline.size()] - outline[0]);
    corners += a / double(outline.size());
  }
  if (!(normal.norm() > 1e-12)) return outline[0] + corners;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const Vector3d a = outline[i] - outline[0], b = outline[i + 1] - outline[0];
    sum += a.cross(b).dot(normal) * (a + b) / 3;
  }
  return outline[0] + sum / normal.squaredNorm();
}

// Inside is where the corners wind around the point.
double distance_outside(const Vector3d& x, std::span<const Vector3d> outline,
                        const Vector3d& normal) {
  double winding = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector3d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    winding += std::atan2((a - x).cross(b - x).dot(normal), (a - x).dot(b - x));
    nearest = std::min(nearest, distance_to_segment(x, a, b));
  }
  return std::abs(winding) > M_PI ? 0 : nearest;
}

}  // namespace cairn
