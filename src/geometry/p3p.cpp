#include "cairn/geometry/p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "cairn/geometry/real_roots.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The pairs of points, and what is known of each: the squared distance a of the points and the
// cosine b of the angle between their rays. The distances lambda along the rays obey
// lambda_i² + lambda_j² - 2 b lambda_i lambda_j = a, which is lambdaᵀ M lambda = a.
constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
struct Constraints {
  double a[3], b[3];

  Matrix3d M(int pair) const {
    const auto [i, j] = kPairs[pair];
    Matrix3d m = Matrix3d::Zero();
    m(i, i) = m(j, j) = 1;
    m(i, j) = m(j, i) = -b[pair];
    return m;
  }
};

Matrix3d adjugate(const Matrix3d& A) {
  Matrix3d adj;
  adj.row(0) = A.col(1).cross(A.col(2));
  adj.row(1) = A.col(2).cross(A.col(0));
  adj.row(2) = A.col(0).cross(A.col(1));
  return adj;
}

// A gamma with det(D1 + gamma D2) = 0; of several the one where the cubic is steepest, which is
// known best. NaN if there is none.
double degenerate_member(const Matrix3d& D1, const Matrix3d& D2) {
  const double c[4] = {D1.determinant(), (adjugate(D1) * D2).trace(), (adjugate(D2) * D1).trace(),
                       D2.determinant()};
  const RealRoots roots = real_roots(c);
  double best = NAN, steepest = -1;
  for (int i = 0; i < roots.count; ++i) {
    const double g = roots.values[i];
    const double slope = std::abs(c[1] + g * (2 * c[2] + 3 * c[3] * g)) / (1 + g * g);
    if (slope > steepest) {
      steepest = slope;
      best = g;
    }
  }
  return best;
}

// A few of Newton's steps on the three constraints.
void polish(const Constraints& known, Vector3d& lambda) {
  for (int iteration = 0; iteration < 3; ++iteration) {
    Vector3d error;
    Matrix3d J = Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto [i, j] = kPairs[k];
      error[k] = lambda[i] * lambda[i] + lambda[j] * lambda[j] -
                 2 * known.b[k] * lambda[i] * lambda[j] - known.a[k];
      J(k, i) = 2 * (lambda[i] - known.b[k] * lambda[j]);
      J(k, j) = 2 * (lambda[j] - known.b[k] * lambda[i]);
    }
    const Vector3d next = lambda - J.inverse() * error;
    // Near a double root the Jacobian is singular; what the closed form gave is then the best.
    if (!next.allFinite() || (next - lambda).norm() > 0.1 * lambda.norm()) return;
    lambda = next;
  }
}

// The transform that moves one triangle onto another of the same shape.
SE3 move_triangle(const std::array<Vector3d, 3>& from, const std::array<Vector3d, 3>& to) {
  const auto frame = [](const std::array<Vector3d, 3>& p) {
    Matrix3d F;
    F.col(0) = (p[1] - p[0]).normalized();
    F.col(2) = F.col(0).cross(p[2] - p[0]).normalized();
    F.col(1) = F.col(2).cross(F.col(0));
    return F;
  };
  const Matrix3d R = frame(to) * frame(from).transpose();
  const Vector3d mean_from = (from[0] + from[1] + from[2]) / 3;
  return SE3(R, (to[0] + to[1] + to[2]) / 3 - R * mean_from);
}

// The distances on the plane wᵀ lambda = 0 that lie on the cone lambdaᵀ D lambda = 0; visit is
// called with each, up to two.
template <typename Visit>
void intersect(const Vector3d& w, const Matrix3d& D, const Constraints& known, const Visit& visit) {
  const Vector3d u = w.unitOrthogonal(), v = w.normalized().cross(u);
  const double a = u.dot(D * u), b = u.dot(D * v), c = v.dot(D * v);
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  // a x² + 2 b x y + c y² = 0 for x : y = q : a and c : q, both free of cancellation.
  const Vector3d directions[2] = {q * u + a * v, c * u + q * v};
  const Matrix3d M = known.M(0) + known.M(1) + known.M(2);
  for (Vector3d lambda : directions) {
    if (lambda.sum() < 0) lambda = -lambda;
    if (!(lambda.minCoeff() > 0)) continue;
    lambda *= std::sqrt((known.a[0] + known.a[1] + known.a[2]) / lambda.dot(M * lambda));
    if (lambda.allFinite()) visit(lambda);
  }
}

}  // namespace

PoseCandidates p3p(const std::array<Vector3d, 3>& rays, const std::array<Vector3d, 3>& points_w) {
  PoseCandidates found;
  const std::array<Vector3d, 3> y = {rays[0].normalized(), rays[1].normalized(),
                                     rays[2].normalized()};
  const Vector3d side1 = points_w[1] - points_w[0], side2 = points_w[2] - points_w[0];
  if (!(side1.cross(side2).norm() > 1e-9 * side1.norm() * side2.norm())) return found;
  Constraints known;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [i, j] = kPairs[k];
    known.a[k] = (points_w[i] - points_w[j]).squaredNorm();
    known.b[k] = y[i].dot(y[j]);
    longest = std::max(longest, known.a[k]);
  }
  for (double& a : known.a) a /= longest;

  const Matrix3d D1 = known.M(0) * known.a[2] - known.M(2) * known.a[0];
  const Matrix3d D2 = known.M(1) * known.a[2] - known.M(2) * known.a[1];
  const double gamma = degenerate_member(D1, D2);
  const Matrix3d D0 = D1 + gamma * D2;
  if (!D0.allFinite()) return found;
  // D0 is a pair of planes: one eigenvalue is zero, the others have opposite signs.
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(D0);
  const double low = eigen.eigenvalues()[0], high = eigen.eigenvalues()[2];
  if (!(low < 0 && high > 0)) return found;
  const double s = std::sqrt(-low / high);
  // On D0's planes D1 and gamma D2 agree up to sign; the one that is not nearly D0 itself tells.
  const Matrix3d& other = std::abs(gamma) * D2.norm() < D1.norm() ? D2 : D1;
  for (const double sign : {1.0, -1.0}) {
    const Vector3d w = eigen.eigenvectors().col(2) - sign * s * eigen.eigenvectors().col(0);
    intersect(w, other, known, [&](Vector3d lambda) {
      polish(known, lambda);
      if (found.count == 4 || !(lambda.minCoeff() > 0)) return;
      lambda *= std::sqrt(longest);
      const SE3 T_cw =
          move_triangle(points_w, {lambda[0] * y[0], lambda[1] * y[1], lambda[2] * y[2]});
      if (T_cw.is_finite()) found.poses[found.count++] = T_cw;
    });
  }
  return found;
}

}  // namespace cairn
