#include "cairn/optimization/factors/point_on_plane_factor.h"

#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {

bool PointOnPlaneFactor::Evaluate(double const* const* parameters, double* residuals,
                                  double** jacobians) const {
  const SE3 T_wr = SE3Manifold::unpack(parameters[0]);
  const Plane plane = PlaneManifold::unpack(parameters[1]);
  const Eigen::Map<const Eigen::Vector3d> X_w(parameters[2]);
  const Plane::Hessian h = plane.hessian();
  const Eigen::Vector3d normal = h.head<3>() * inverse_sigma_;
  const Eigen::Vector3d X_r = T_wr.inverse() * X_w;
  residuals[0] = normal.dot(X_r) + h[3] * inverse_sigma_;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {  // T_wr · exp(ξ) moves the point in r by -ρ + [X]× ω
    Eigen::Map<Eigen::Matrix<double, 1, 7>> J(jacobians[0]);
    J << -normal.transpose(), normal.cross(X_r).transpose(), 0;
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 1, 4>> J(jacobians[1]);
    const Eigen::RowVector4d by_hessian(X_r.x(), X_r.y(), X_r.z(), 1);
    J << inverse_sigma_ * by_hessian * plane.hessian_by_step(), 0;
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 1, 3>> J(jacobians[2]);
    J = (T_wr.rotation() * normal).transpose();
  }
  return true;
}

}  // namespace cairn
