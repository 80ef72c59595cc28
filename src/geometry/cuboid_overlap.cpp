#include "cairn/geometry/cuboid_overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace cairn {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

// Of the size: the second cuboid is taken larger by this, so that faces in one plane have an order.
constexpr double kMargin = 1e-9;

// What of a convex polygon has normalᵀ x ≤ offset (Sutherland and Hodgman).
Polygon clipped(const Polygon& polygon, const Vector3d& normal, double offset) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double dp = normal.dot(p) - offset, dq = normal.dot(q) - offset;
    if (dp <= 0) kept.push_back(p);
    if ((dp <= 0) != (dq <= 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
  }
  return kept;
}

double area(const Polygon& polygon) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return twice.norm() / 2;
}

// ∫ xᵀ n dA / 3 over that part of the faces of `of` that is inside of `inside`: seen from its
// middle, where that integral is smallest and loses least to rounding.
double share_of_volume(const Cuboid& of, const Cuboid& inside, const Vector3d& origin) {
  const Eigen::Matrix3d R = of.T.matrix3(), N = inside.T.matrix3();
  double sum = 0;
  for (int k = 0; k < 6; ++k) {
    const int axis = k % 3;
    const Vector3d normal = (k < 3 ? 1 : -1) * R.col(axis);
    const Vector3d middle = of.T.translation() + of.half[axis] * normal;
    const Vector3d u = of.half[(axis + 1) % 3] * R.col((axis + 1) % 3);
    const Vector3d v = of.half[(axis + 2) % 3] * R.col((axis + 2) % 3);
    Polygon face{middle + u + v, middle - u + v, middle - u - v, middle + u - v};
    for (int j = 0; j < 6 && face.size() > 2; ++j) {
      const Vector3d n = (j < 3 ? 1 : -1) * N.col(j % 3);
      face = clipped(face, n, n.dot(inside.T.translation()) + inside.half[j % 3]);
    }
    sum += area(face) * normal.dot(middle - origin) / 3;
  }
  return sum;
}

}  // namespace

Cuboid cuboid_of(const Ellipsoid& ellipsoid) { return {ellipsoid.T, ellipsoid.semi_axes}; }

double intersection_over_union(const Cuboid& a, const Cuboid& b) {
  Cuboid larger = b;
  larger.half.array() += kMargin * std::max(a.half.maxCoeff(), b.half.maxCoeff());
  const Vector3d& origin = a.T.translation();
  const double shared =
      std::clamp(share_of_volume(a, larger, origin) + share_of_volume(larger, a, origin), 0.0,
                 std::min(a.volume(), b.volume()));
  return shared / (a.volume() + b.volume() - shared);
}

}  // namespace cairn
