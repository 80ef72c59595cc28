#include "cairn/optimization/factors/object_turn_factor.h"

#include "cairn/optimization/object_manifold.h"

namespace cairn {

bool ObjectTurnFactor::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const Ellipsoid object = ObjectManifold::unpack(parameters[0]);
  Eigen::Matrix3d by_step;
  Eigen::Vector3d::Map(residuals) = turn_residual(prior_, object.T.rotation(), &by_step);
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<Eigen::Matrix<double, 3, ObjectManifold::kAmbient, Eigen::RowMajor>> J(jacobians[0]);
  J.setZero();
  J.middleCols<3>(3) = by_step;
  return true;
}

}  // namespace cairn
