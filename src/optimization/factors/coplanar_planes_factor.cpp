#include "cairn/optimization/factors/coplanar_planes_factor.h"

#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {

CoplanarPlanesFactor::CoplanarPlanesFactor(PlaneFrames frames, const Eigen::Vector3d& place,
                                           double sigma)
    : frames_(frames), place_(place), inverse_sigma_(1.0 / sigma) {
  set_num_residuals(1);
  *mutable_parameter_block_sizes() = plane_pair_blocks(frames);
}

bool CoplanarPlanesFactor::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  const bool two = frames_ == PlaneFrames::kTwo;
  const int block1 = two ? 1 : 0, block2 = two ? 3 : 1;  // of the planes; poses come before them
  const Plane plane1 = PlaneManifold::unpack(parameters[block1]);
  const Plane plane2 = PlaneManifold::unpack(parameters[block2]);
  SE3 T_12;
  if (two) {
    T_12 = SE3Manifold::unpack(parameters[0]).inverse() * SE3Manifold::unpack(parameters[2]);
  }
  const Eigen::Vector3d n2 = plane2.normal();
  const double off = plane2.signed_distance(place_);
  const Eigen::Vector3d X2 = place_ - off * n2, X1 = T_12 * X2;  // of the second plane
  residuals[0] = plane1.signed_distance(X1) * inverse_sigma_;
  if (jacobians == nullptr) return true;
  const Eigen::Vector3d by_X1 = plane1.normal() * inverse_sigma_;
  const Eigen::Vector3d by_X2 = T_12.rotation().conjugate() * by_X1;
  const auto write_plane = [&](int block, const Eigen::RowVector4d& by_hessian,
                               const Plane& plane) {
    if (jacobians[block] == nullptr) return;
    Eigen::Map<Eigen::RowVector4d> J(jacobians[block]);
    J << by_hessian * plane.hessian_by_step(), 0;
  };
  Eigen::RowVector4d by_hessian1, by_hessian2;
  by_hessian1 << X1.transpose() * inverse_sigma_, inverse_sigma_;
  by_hessian2 << (-off * by_X2 - n2.dot(by_X2) * place_).transpose(), -n2.dot(by_X2);
  write_plane(block1, by_hessian1, plane1);
  write_plane(block2, by_hessian2, plane2);
  // T_wr · exp(ξ) moves a point that hangs on r by ρ + ω × X in r, and one that does not the other
  // way round.
  const auto write_pose = [&](int block, const Eigen::Vector3d& by_X, const Eigen::Vector3d& X) {
    if (!two || jacobians[block] == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, 1, 7>> J(jacobians[block]);
    J << by_X.transpose(), X.cross(by_X).transpose(), 0;
  };
  write_pose(0, -by_X1, X1);
  write_pose(2, by_X2, X2);
  return true;
}

}  // namespace cairn
