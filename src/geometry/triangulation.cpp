#include "cairn/geometry/triangulation.h"

#include <cmath>

namespace cairn {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

}  // namespace cairn
