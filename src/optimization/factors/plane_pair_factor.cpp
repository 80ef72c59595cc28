#include "cairn/optimization/factors/plane_pair_factor.h"

#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

std::vector<std::int32_t> plane_pair_blocks(PlaneFrames frames) {
  if (frames == PlaneFrames::kTwo) return {7, 4, 7, 4};
  return {4, 4};
}

PlanePairFactor::PlanePairFactor(PlaneFrames frames, int residuals) : frames_(frames) {
  set_num_residuals(residuals);
  *mutable_parameter_block_sizes() = plane_pair_blocks(frames);
}

bool PlanePairFactor::Evaluate(double const* const* parameters, double* residuals,
                               double** jacobians) const {
  const bool two = frames_ == PlaneFrames::kTwo;
  const int block1 = two ? 1 : 0, block2 = two ? 3 : 1;  // of the planes; poses come before them
  const Plane plane1 = PlaneManifold::unpack(parameters[block1]);
  const Plane plane2 = PlaneManifold::unpack(parameters[block2]);
  Matrix3d R_12 = Matrix3d::Identity();
  if (two) {
    R_12 = (SE3Manifold::unpack(parameters[0]).rotation().conjugate() *
            SE3Manifold::unpack(parameters[2]).rotation())
               .toRotationMatrix();
  }
  const Vector3d n1 = plane1.normal(), n2 = R_12 * plane2.normal();  // both in the first frame

  ByNormal by_n1(num_residuals(), 3), by_n2(num_residuals(), 3);
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = relate(n1, n2, by_n1, by_n2);
  if (jacobians == nullptr) return true;
  const auto write_plane = [&](int block, const ByNormal& by_normal, const Plane& plane) {
    if (jacobians[block] == nullptr) return;
    Eigen::Map<RowMajor> J(jacobians[block], num_residuals(), 4);
    J.leftCols<3>() = by_normal * plane.hessian_by_step().topRows<3>();
    J.col(3).setZero();
  };
  // Only the rotation of a pose matters.
  const auto write_pose = [&](int block, const ByNormal& by_omega) {
    if (jacobians[block] == nullptr) return;
    Eigen::Map<RowMajor> J(jacobians[block], num_residuals(), 7);
    J.setZero();
    J.middleCols<3>(3) = by_omega;
  };
  write_plane(block1, by_n1, plane1);
  write_plane(block2, by_n2 * R_12, plane2);
  if (two) {
    write_pose(0, by_n2 * skew(n2));
    write_pose(2, -by_n2 * R_12 * skew(plane2.normal()));
  }
  return true;
}

}  // namespace cairn
