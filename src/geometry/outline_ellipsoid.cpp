#include "cairn/geometry/outline_ellipsoid.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "cairn/geometry/sphere_lattice.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr int kDirections = 400, kSteps = 30;
constexpr double kDamping = 1e-6;    // of the mean diagonal number
constexpr double kFlattest = 1e-4;   // least axis of the points' spread over the largest
constexpr double kLeastGrip = 1e-9;  // |A n|, of what has no extent along n

// How far the points reach in a direction.
struct Reach {
  Vector3d n;
  double most = -std::numeric_limits<double>::infinity();
};

std::vector<Reach> reaches(const std::vector<Vector3d>& points) {
  std::vector<Reach> result;
  for (int i = 0; i < kDirections; ++i) {
    Reach& reach = result.emplace_back(Reach{sphere_lattice(i, kDirections)});
    for (const Vector3d& x : points) reach.most = std::max(reach.most, reach.n.dot(x));
  }
  return result;
}

// Derivative of |A n| by the six numbers of a symmetric A: 11, 22, 33, 12, 13, 23.
Eigen::Matrix<double, 6, 1> by_symmetric(const Vector3d& u, const Vector3d& n) {
  Eigen::Matrix<double, 6, 1> d;
  d << u.cwiseProduct(n), u[0] * n[1] + u[1] * n[0], u[0] * n[2] + u[2] * n[0],
      u[1] * n[2] + u[2] * n[1];
  return d;
}

Matrix3d symmetric(const Eigen::Matrix<double, 6, 1>& a) {
  Matrix3d A;
  A << a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2];
  return A;
}

}  // namespace

std::optional<Ellipsoid> outline_ellipsoid(const std::vector<Vector3d>& points) {
  if (points.size() < 4) return std::nullopt;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : points) mean += x / double(points.size());
  Matrix3d spread = Matrix3d::Zero();
  for (const Vector3d& x : points) {
    spread += (x - mean) * (x - mean).transpose() / double(points.size());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> start(spread);
  const Vector3d squares = start.eigenvalues();
  if (!(squares[0] > kFlattest * kFlattest * squares[2])) return std::nullopt;
  // E = {A u + c : |u| <= 1} with a symmetric A; as large as a shell with this spread.
  const Matrix3d A0 = std::sqrt(3.0) * start.operatorSqrt();
  Vector9d x;
  x << A0.diagonal(), A0(0, 1), A0(0, 2), A0(1, 2), mean;
  const std::vector<Reach> all = reaches(points);
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, 9, 9> H = Eigen::Matrix<double, 9, 9>::Zero();
    Vector9d g = Vector9d::Zero();
    for (const auto& [n, most] : all) {
      const Vector3d An = symmetric(x.head<6>()) * n;
      const double grip = std::max(An.norm(), kLeastGrip);
      Vector9d J;
      J << by_symmetric(An / grip, n), n;
      H += J * J.transpose();
      g += (grip + n.dot(x.tail<3>()) - most) * J;
    }
    H.diagonal().array() += kDamping * H.diagonal().mean();
    x -= H.ldlt().solve(g);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(symmetric(x.head<6>()));
  Matrix3d R = axes.eigenvectors();
  if (R.determinant() < 0) R.col(0) *= -1;
  const Vector3d semi_axes = axes.eigenvalues().cwiseAbs();
  if (!x.allFinite() || !(semi_axes.minCoeff() > 0)) return std::nullopt;
  return Ellipsoid{SE3(R, x.tail<3>()), semi_axes};
}

}  // namespace cairn
