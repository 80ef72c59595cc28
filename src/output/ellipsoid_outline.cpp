#include "cairn/output/ellipsoid_outline.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/output/outline_projection.h"

namespace cairn {
namespace {

constexpr int kCorners = 40;

}  // namespace

std::vector<cv::Point2f> project_ellipsoid(const Ellipsoid& ellipsoid, const SE3& T_cw,
                                           const Camera& camera) {
  // The rays that touch the ellipsoid, where they have depth 1, are a flat outline like another.
  const Pinhole one{1, 1, 0, 0};
  std::vector<Eigen::Vector3d> rays;
  for (const Eigen::Vector2d& at :
       projected_outline(one, {T_cw * ellipsoid.T, ellipsoid.semi_axes}, kCorners)) {
    rays.push_back(one.unproject(at));
  }
  return project_outline(rays, SE3(), camera);
}

std::vector<Eigen::Vector2d> ellipsoid_shadow(const Ellipsoid& ellipsoid,
                                              const Eigen::Vector3d& right,
                                              const Eigen::Vector3d& forward) {
  // {A u : |u| <= 1} is an ellipse with A Aᵀ for its shape, and so are the columns of its root.
  Eigen::Matrix<double, 2, 3> onto;
  onto << right.transpose(), forward.transpose();
  const Eigen::Matrix<double, 2, 3> A =
      onto * ellipsoid.T.matrix3() * ellipsoid.semi_axes.asDiagonal();
  const Eigen::Matrix2d root = Eigen::LLT<Eigen::Matrix2d>(A * A.transpose()).matrixL();
  std::vector<Eigen::Vector2d> outline;
  for (int k = 0; k <= kCorners; ++k) {
    const double turn = 2 * M_PI * (k % kCorners) / kCorners;
    outline.emplace_back(onto * ellipsoid.centre() +
                         root * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
  }
  return outline;
}

}  // namespace cairn
