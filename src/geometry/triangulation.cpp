#include "cairn/geometry/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cairn/geometry/parallax.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d centre(const SE3& T_cw) { return -(T_cw.rotation().conjugate() * T_cw.translation()); }

// The homogeneous point that the linear equations of all views leave, in the first camera's frame
// (there numbers are small wherever the world's origin is) and in units of the mean baseline.
Vector3d linear_point(std::span<const TriangulationView> views, const Pinhole& camera) {
  const SE3 T_wf = views[0].T_cw.inverse();
  double baseline = 0;
  for (const TriangulationView& view : views) baseline += (view.T_cw * T_wf).translation().norm();
  baseline /= static_cast<double>(views.size() - 1);
  Eigen::Matrix4d AtA = Eigen::Matrix4d::Zero();
  for (const TriangulationView& view : views) {
    const SE3 T_cf = view.T_cw * T_wf;
    Eigen::Matrix<double, 3, 4> P;
    P << T_cf.matrix3(), T_cf.translation() / baseline;
    const Vector3d ray = camera.unproject(view.pixel);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::RowVector4d row = (ray[axis] * P.row(2) - P.row(axis)) / view.sigma_px;
      AtA.noalias() += row.transpose() * row;
    }
  }
  if (!AtA.allFinite()) return Vector3d::Constant(NAN);
  const Eigen::Vector4d X =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(AtA).eigenvectors().col(0);
  return T_wf * Vector3d(baseline * X.head<3>() / X[3]);
}

// One step of Gauss-Newton on the reprojection errors. False where none is defined.
bool improve(std::span<const TriangulationView> views, const Pinhole& camera, Vector3d& point) {
  Matrix3d H = Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  for (const TriangulationView& view : views) {
    const Matrix3d R = view.T_cw.matrix3();
    const Vector3d X = R * point + view.T_cw.translation();
    const double z = 1 / X.z();
    Eigen::Matrix<double, 2, 3> J;
    J << camera.fx * z, 0, -camera.fx * X.x() * z * z, 0, camera.fy * z, -camera.fy * X.y() * z * z;
    const Eigen::Matrix<double, 2, 3> JR = J * R / view.sigma_px;
    const Vector2d r = (camera.project(X) - view.pixel) / view.sigma_px;
    H.noalias() += JR.transpose() * JR;
    g.noalias() += JR.transpose() * r;
  }
  const Vector3d step = H.ldlt().solve(-g);
  if (!step.allFinite()) return false;
  const double distance = (point - centre(views[0].T_cw)).norm();
  // A far point's depth can shoot off; half its distance is as far as the linearisation reaches.
  point += step * std::min(1.0, 0.5 * distance / std::max(step.norm(), 1e-300));
  return step.norm() > 1e-9 * distance;
}

}  // namespace

TwoRayPoint triangulate_two_rays(const SE3& T_21, const Vector3d& ray1, const Vector3d& ray2) {
  return triangulate_two_rays(T_21.matrix3(), T_21.translation(), ray1, ray2);
}

TwoRayPoint triangulate_two_rays(const Matrix3d& R_21, const Vector3d& t_21, const Vector3d& ray1,
                                 const Vector3d& ray2) {
  TwoRayPoint result;
  const Vector3d m = (R_21 * ray1).normalized(), f = ray2.normalized();
  const double baseline = t_21.norm();
  if (!(baseline > 0)) return result;
  // Unit normals n of epipolar planes are perpendicular to t: n = cos(a) u + sin(a) v. The cost
  // (m·n)² + (f·n)² is a quadratic form in (cos a, sin a); n is its eigenvector of the smaller
  // eigenvalue.
  const Vector3d t = t_21 / baseline;
  const Vector3d u = t.unitOrthogonal(), v = t.cross(u);
  const double mu = m.dot(u), mv = m.dot(v), fu = f.dot(u), fv = f.dot(v);
  const double angle =
      0.5 * std::atan2(2 * (mu * mv + fu * fv), mu * mu + fu * fu - mv * mv - fv * fv);
  const Vector3d n = -std::sin(angle) * u + std::cos(angle) * v;
  const Vector3d m_plane = m - m.dot(n) * n, f_plane = f - f.dot(n) * n;

  // depth2 f' = depth1 m' + t, crossed with f' and with m'.
  const Vector3d z = f_plane.cross(m_plane);
  const double z2 = z.squaredNorm();
  result.parallax = std::atan2(std::sqrt(z2), f_plane.dot(m_plane));
  if (!(z2 > 1e-20)) return result;
  const double scale1 = z.dot(t_21.cross(f_plane)) / z2, scale2 = z.dot(t_21.cross(m_plane)) / z2;
  result.depth1 = scale1 * m_plane.norm();
  result.depth2 = scale2 * f_plane.norm();
  result.point = R_21.transpose() * (scale1 * m_plane);
  return result;
}

std::string describe(Triangulation::Cause cause) {
  switch (cause) {
    case Triangulation::Cause::kNone:
      return "usable";
    case Triangulation::Cause::kTooFewViews:
      return "fewer than two views";
    case Triangulation::Cause::kNotFinite:
      return "the rays do not meet in a finite point";
    case Triangulation::Cause::kBehindCamera:
      return "the point lies behind a camera";
    case Triangulation::Cause::kSmallParallax:
      return "the parallax is too small";
    case Triangulation::Cause::kLargeError:
      return "the point reprojects too far from a measurement";
  }
  return "unknown";
}

Triangulation triangulate(std::span<const TriangulationView> views, const Pinhole& camera,
                          const TriangulationOptions& options) {
  using Cause = Triangulation::Cause;
  Triangulation result;
  if (views.size() < 2) return result;
  result.point = linear_point(views, camera);
  for (int i = 0; i < options.iterations && improve(views, camera, result.point); ++i) {
  }
  result.cause = Cause::kNotFinite;
  if (!result.point.allFinite()) return result;

  result.min_depth = INFINITY;
  result.max_depth = -INFINITY;
  for (const TriangulationView& view : views) {
    const Vector3d X = view.T_cw * result.point;
    result.min_depth = std::min(result.min_depth, X.z());
    result.max_depth = std::max(result.max_depth, X.z());
    result.max_error_sigmas =
        std::max(result.max_error_sigmas, (camera.project(X) - view.pixel).norm() / view.sigma_px);
  }
  result.parallax_deg =
      largest_parallax(views, result.point, [](const auto& v) { return centre(v.T_cw); }) * 180 /
      M_PI;
  if (!(result.min_depth > 0)) {
    result.cause = Cause::kBehindCamera;
  } else if (!(result.parallax_deg >= options.min_parallax_deg)) {
    result.cause = Cause::kSmallParallax;
  } else if (!(result.max_error_sigmas <= options.max_error_sigmas)) {
    result.cause = Cause::kLargeError;
  } else {
    result.cause = Cause::kNone;
  }
  return result;
}

}  // namespace cairn
