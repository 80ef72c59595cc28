#include "cairn/geometry/dual_quadric.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kRounding = 1e-13;  // of the largest number: what is below is not known

}  // namespace

Matrix4d dual_quadric(const Ellipsoid& ellipsoid) {
  Eigen::Vector4d diagonal;
  diagonal << ellipsoid.semi_axes.cwiseAbs2(), -1;
  const Matrix4d T = ellipsoid.T.matrix();
  return T * diagonal.asDiagonal() * T.transpose();
}

std::optional<Ellipsoid> ellipsoid_of(const Matrix4d& Q) {
  if (!Q.allFinite()) return std::nullopt;
  const double largest = Q.cwiseAbs().maxCoeff();
  if (!(std::abs(Q(3, 3)) > kRounding * largest)) return std::nullopt;
  const Matrix4d scaled = (Q + Q.transpose()) / (-2 * Q(3, 3));  // the last number becomes -1
  if (!scaled.allFinite()) return std::nullopt;
  const Vector3d centre = -scaled.topRightCorner<3, 1>();
  const Matrix3d shape = scaled.topLeftCorner<3, 3>() + centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(shape);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Vector3d squares = solver.eigenvalues();
  const double known = kRounding * (shape.norm() + centre.squaredNorm());
  if (!squares.allFinite() || !(squares.minCoeff() > known)) return std::nullopt;
  Matrix3d R = solver.eigenvectors();
  if (R.determinant() < 0) R.col(2) = -R.col(2);
  return Ellipsoid{SE3(R, centre), squares.cwiseSqrt()};
}

double tangency(const Matrix4d& Q, const Eigen::Vector4d& plane) {
  return plane.dot(Q * plane) / Q.norm();
}

}  // namespace cairn
