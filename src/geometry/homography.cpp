#include "cairn/geometry/homography.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Vector9d = Eigen::Matrix<double, 9, 1>;

// Moves points so that their centroid is the origin and their mean squared length is 2.
struct Normalization {
  Vector2d centre = Vector2d::Zero();
  double scale = 1;

  Vector2d operator()(const Vector2d& x) const { return scale * (x - centre); }
  Matrix3d matrix() const {
    Matrix3d T;
    T << scale, 0, -scale * centre.x(), 0, scale, -scale * centre.y(), 0, 0, 1;
    return T;
  }
};

template <typename Include>
Normalization normalization(std::span<const NormalizedMatch> matches, const Include& include,
                            int first) {
  Normalization T;
  double squares = 0;
  int n = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!include(i)) continue;
    T.centre += matches[i].segment<2>(first);
    squares += matches[i].segment<2>(first).squaredNorm();
    ++n;
  }
  T.centre /= n;
  T.scale = std::sqrt(2.0 / (squares / n - T.centre.squaredNorm()));
  return T;
}

// The two equations of x2 × (H x1) = 0 that are independent, as rows over the row-major H.
Eigen::Matrix<double, 9, 2> equations(const Vector2d& x1, const Vector2d& x2) {
  Eigen::Matrix<double, 9, 2> A;
  A.col(0) << 0, 0, 0, -x1.x(), -x1.y(), -1, x2.y() * x1.x(), x2.y() * x1.y(), x2.y();
  A.col(1) << x1.x(), x1.y(), 1, 0, 0, 0, -x2.x() * x1.x(), -x2.x() * x1.y(), -x2.x();
  return A;
}

Matrix3d denormalize(const Vector9d& h, const Normalization& T1, const Normalization& T2) {
  const Matrix3d H = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
  Matrix3d T2_inverse;
  T2_inverse << 1 / T2.scale, 0, T2.centre.x(), 0, 1 / T2.scale, T2.centre.y(), 0, 0, 1;
  return (T2_inverse * H * T1.matrix()).normalized();
}

}  // namespace

Matrix3d fit_homography(std::span<const NormalizedMatch> matches, std::span<const char> inliers) {
  const auto include = [&](std::size_t i) { return inliers[i] != 0; };
  const Normalization T1 = normalization(matches, include, 0);
  const Normalization T2 = normalization(matches, include, 2);
  Eigen::Matrix<double, 9, 9> AtA = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!include(i)) continue;
    const auto A = equations(T1(matches[i].head<2>()), T2(matches[i].tail<2>()));
    AtA.noalias() += A * A.transpose();
  }
  if (!AtA.allFinite()) return Matrix3d::Constant(NAN);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(AtA);
  return denormalize(eigen.eigenvectors().col(0), T1, T2);
}

Matrix3d fit_homography(const std::array<NormalizedMatch, 4>& matches) {
  const auto all = [](std::size_t) { return true; };
  const Normalization T1 = normalization(matches, all, 0);
  const Normalization T2 = normalization(matches, all, 2);
  Eigen::Matrix<double, 9, 8> At;
  for (int i = 0; i < 4; ++i) {
    At.middleCols<2>(2 * i) = equations(T1(matches[i].head<2>()), T2(matches[i].tail<2>()));
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 8>> qr(At);
  // The last column of Q is perpendicular to all equations.
  const Vector9d h = qr.householderQ() * Vector9d::Unit(8);
  return denormalize(h, T1, T2);
}

HomographyMotions decompose_homography(const Matrix3d& H_any_scale) {
  HomographyMotions result;
  if (!H_any_scale.allFinite()) return result;
  const Eigen::JacobiSVD<Matrix3d> svd(H_any_scale, Eigen::ComputeFullV);
  const double middle = svd.singularValues()[1];
  if (!(middle > 1e-12)) return result;
  // det(R + t nᵀ / d) is positive where both cameras are on the same side of the plane.
  const double sign = H_any_scale.determinant() < 0 ? -1 : 1;
  const Matrix3d H = sign / middle * H_any_scale;
  const double s1 = std::pow(svd.singularValues()[0] / middle, 2);
  const double s3 = std::pow(svd.singularValues()[2] / middle, 2);
  if (!(s1 - s3 > 1e-6)) return result;
  Matrix3d V = svd.matrixV();
  if (V.determinant() < 0) V *= -1;

  const double a = std::sqrt(std::max(0.0, 1 - s3)), b = std::sqrt(std::max(0.0, s1 - 1));
  for (const double side : {1.0, -1.0}) {
    const Vector3d u = (a * V.col(0) + side * b * V.col(2)) / std::sqrt(s1 - s3);
    const Vector3d v2 = V.col(1), normal = v2.cross(u);
    Matrix3d U, W;
    U << v2, u, normal;
    W << H * v2, H * u, (H * v2).cross(H * u);
    const Matrix3d R = W * U.transpose();
    const Vector3d t = (H - R) * normal;
    if (!(t.norm() > 1e-9)) continue;
    result.motions[result.count++] = SE3(R, t.normalized());
    result.motions[result.count++] = SE3(R, -t.normalized());
  }
  return result;
}

}  // namespace cairn
