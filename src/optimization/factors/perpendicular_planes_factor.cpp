#include "cairn/optimization/factors/perpendicular_planes_factor.h"

namespace cairn {

PlanePairFactor::Residual PerpendicularPlanesFactor::relate(const Eigen::Vector3d& n1,
                                                            const Eigen::Vector3d& n2,
                                                            ByNormal& by_n1,
                                                            ByNormal& by_n2) const {
  by_n1 = inverse_sigma_ * n2.transpose();
  by_n2 = inverse_sigma_ * n1.transpose();
  return Residual::Constant(1, n1.dot(n2) * inverse_sigma_);
}

}  // namespace cairn
