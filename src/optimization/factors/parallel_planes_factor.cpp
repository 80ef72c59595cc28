#include "cairn/optimization/factors/parallel_planes_factor.h"

namespace cairn {

PlanePairFactor::Residual ParallelPlanesFactor::relate(const Eigen::Vector3d& n1,
                                                       const Eigen::Vector3d& n2, ByNormal& by_n1,
                                                       ByNormal& by_n2) const {
  const double cosine = n1.dot(n2);
  if (form_ == FactorForm::kPaper) {
    const double side = cosine < 0 ? -1 : 1;
    by_n1 = side * inverse_sigma_ * n2.transpose();
    by_n2 = side * inverse_sigma_ * n1.transpose();
    return Residual::Constant(1, (side * cosine - 1) * inverse_sigma_);
  }
  Eigen::Vector3d spin;
  const Eigen::Matrix<double, 3, 2> axes = tangent_axes(n1, &spin);
  const Eigen::Vector3d t1 = axes.col(0), t2 = axes.col(1);
  const double u = t1.dot(n2), v = t2.dot(n2);
  by_n2.row(0) = -inverse_sigma_ * t2.transpose();
  by_n2.row(1) = inverse_sigma_ * t1.transpose();
  by_n1.row(0) = inverse_sigma_ * (cosine * t2 + u * spin).transpose();
  by_n1.row(1) = inverse_sigma_ * (-cosine * t1 + v * spin).transpose();
  Residual e(2);
  e << -v * inverse_sigma_, u * inverse_sigma_;
  return e;
}

}  // namespace cairn
