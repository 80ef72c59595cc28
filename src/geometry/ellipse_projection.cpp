#include "cairn/geometry/ellipse_projection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of the squared depth: nearer to the camera's plane than this a picture has no use for.
constexpr double kFrontMargin = 1e-9;

// Lines that touch the ellipse, lᵀ C* l = 0, in the normalised picture (focal length 1).
struct DualConic {
  Matrix3d C;

  explicit DualConic(const Ellipsoid& in_camera) {
    const Matrix3d W = in_camera.T.matrix3() * in_camera.semi_axes.asDiagonal();
    C = W * W.transpose() - in_camera.centre() * in_camera.centre().transpose();
  }
  bool in_front(double depth) const { return depth > 0 && C(2, 2) < -kFrontMargin * depth * depth; }
  // x (or y, with `axis` 1) of the two upright (level) lines: root ∓ over C33.
  double root(int axis) const {
    return std::sqrt(C(axis, 2) * C(axis, 2) - C(axis, axis) * C(2, 2));
  }
  double edge(int axis, double root) const { return (C(axis, 2) + root) / C(2, 2); }
};

// The line that is an edge at `x` is lᵀ = (1, 0, -x), or (0, 1, -x). With a = Rᵀ l, lᵀ C* l =
// |diag(s) a|² - (lᵀ c)² stays zero when the ellipsoid moves; by x it changes with 2 `root`.
Eigen::Matrix<double, 1, 9> edge_by_ellipsoid(const Ellipsoid& e, int axis, double x, double root) {
  Vector3d line = Vector3d::Unit(axis);
  line.z() = -x;
  const Vector3d a = e.T.rotation().conjugate() * line;
  const Vector3d b = e.semi_axes.cwiseAbs2().cwiseProduct(a);
  Eigen::Matrix<double, 1, 9> derivative;
  derivative << -line.dot(e.centre()) * a.transpose(), b.cross(a).transpose(),
      b.cwiseProduct(a).transpose();
  return derivative / -root;
}

}  // namespace

std::optional<Box2> projected_box(const Pinhole& pinhole, const Ellipsoid& in_camera,
                                  BoxByEllipsoid* derivative) {
  const DualConic conic(in_camera);
  if (!conic.in_front(in_camera.centre().z())) return std::nullopt;
  const double focal[2] = {pinhole.fx, pinhole.fy}, middle[2] = {pinhole.cx, pinhole.cy};
  double edges[4];
  for (int axis = 0; axis < 2; ++axis) {
    const double root = conic.root(axis);
    if (!(root > 0) || !std::isfinite(root)) return std::nullopt;
    for (const int far : {0, 1}) {
      // C33 is negative, so that the larger numerator gives the smaller coordinate.
      const double signed_root = far ? -root : root, x = conic.edge(axis, signed_root);
      const int row = axis + 2 * far;
      edges[row] = focal[axis] * x + middle[axis];
      if (!derivative) continue;
      derivative->row(row) = focal[axis] * edge_by_ellipsoid(in_camera, axis, x, signed_root);
    }
  }
  return Box2{edges[0], edges[1], edges[2], edges[3]};
}

std::vector<Vector2d> projected_outline(const Pinhole& pinhole, const Ellipsoid& in_camera,
                                        int count) {
  if (!projected_box(pinhole, in_camera)) return {};
  const Matrix3d C = DualConic(in_camera).C;
  // The dual conic of the ellipse {m + L u : |u| = 1} is (L Lᵀ - m mᵀ, -m; -mᵀ, -1), up to scale.
  const Vector2d m = C.topRightCorner<2, 1>() / C(2, 2);
  const Eigen::Matrix2d shape = m * m.transpose() - C.topLeftCorner<2, 2>() / C(2, 2);
  const double l00 = std::sqrt(shape(0, 0)), l10 = shape(1, 0) / l00;
  const double l11 = std::sqrt(std::max(0.0, shape(1, 1) - l10 * l10));
  std::vector<Vector2d> outline;
  outline.reserve(std::size_t(std::max(0, count)));
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count, u = std::cos(angle), v = std::sin(angle);
    const Vector3d ray(m.x() + l00 * u, m.y() + l10 * u + l11 * v, 1);
    outline.push_back(pinhole.project(ray));
  }
  return outline;
}

}  // namespace cairn
