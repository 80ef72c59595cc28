#include "cairn/geometry/ellipsoid.h"

#include <algorithm>
#include <cmath>

#include "cairn/geometry/sphere_lattice.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRays = 2000;

// Of the part of a unit ball along one ray that lies in r0 to r1 from the centre.
double shell(double r0, double r1) {
  r0 = std::clamp(r0, 0.0, 1.0);
  r1 = std::clamp(r1, 0.0, 1.0);
  return r1 * r1 * r1 - r0 * r0 * r0;
}

// The share of the unit ball that lies in {x : |M x + c| ≤ 1}.
double share_of_ball(const Matrix3d& M, const Vector3d& c) {
  const double constant = c.squaredNorm() - 1;
  double sum = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vector3d v = M * sphere_lattice(i, kRays);  // |r v + c|² = 1
    const double half = v.dot(c), square = v.squaredNorm();
    const double discriminant = half * half - square * constant;
    if (discriminant <= 0) continue;
    const double root = std::sqrt(discriminant);
    sum += shell((-half - root) / square, (-half + root) / square);
  }
  return sum / kRays;
}

}  // namespace

double intersection_over_union(const Ellipsoid& a, const Ellipsoid& b) {
  if (a.volume() > b.volume()) return intersection_over_union(b, a);
  const SE3 T_ba = b.T.inverse() * a.T;
  const Vector3d inverse = b.semi_axes.cwiseInverse();
  const Matrix3d M = inverse.asDiagonal() * T_ba.matrix3() * a.semi_axes.asDiagonal();
  const double shared = a.volume() * share_of_ball(M, inverse.cwiseProduct(T_ba.translation()));
  return shared / (a.volume() + b.volume() - shared);
}

}  // namespace cairn
