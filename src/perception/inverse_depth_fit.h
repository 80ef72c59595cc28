#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>

namespace cairn {

/// Least squares for a plane in inverse depth. With X = z r and r = (x, y, 1) the plane n'X + d = 0
/// says 1/z = m'r with m = -n/d: linear in m, exact for any lens, and with the noise of depth where
/// it belongs (Konolige and Agrawal 2008 fit disparity for the same reason).
class InverseDepthFit {
 public:
  /// A ray (x, y, 1).
  void add(double x, double y, double inverse_depth, double weight) {
    const double wx = weight * x, wy = weight * y;
    xx_ += wx * x;
    xy_ += wx * y;
    yy_ += wy * y;
    x_ += wx;
    y_ += wy;
    one_ += weight;
    b_ += inverse_depth * Eigen::Vector3d(wx, wy, weight);
  }

  /// m, or nothing where the rays span no plane.
  std::optional<Eigen::Vector3d> solve() const {
    Eigen::Matrix3d A;
    A << xx_, xy_, x_, xy_, yy_, y_, x_, y_, one_;
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
    const Eigen::Vector3d pivots = ldlt.vectorD();
    if (!(pivots.minCoeff() > 1e-12 * pivots.maxCoeff())) return std::nullopt;
    const Eigen::Vector3d m = ldlt.solve(b_);
    if (!m.allFinite() || !(m.squaredNorm() > 1e-12)) return std::nullopt;
    return m;
  }

 private:
  double xx_ = 0, xy_ = 0, yy_ = 0, x_ = 0, y_ = 0, one_ = 0;
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero();
};

/// The plane (n, d) of m: unit normal towards the camera, so d > 0; metres.
inline Eigen::Vector4d plane_of_inverse_depth(const Eigen::Vector3d& m) {
  return (Eigen::Vector4d() << -m, 1).finished() / m.norm();
}

/// 1/z at which a ray (z = 1) meets a plane.
inline double inverse_depth_at(const Eigen::Vector4d& plane, const Eigen::Vector3d& ray) {
  return -plane.head<3>().dot(ray) / plane[3];
}

}  // namespace cairn
