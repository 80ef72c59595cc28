#include "cairn/geometry/wasserstein.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cairn {

double wasserstein_distance(const Ellipsoid& a, const Ellipsoid& b) {
  // With Σ = L Lᵀ the trace of (Σ₁^½ Σ₂ Σ₁^½)^½ is the sum of the singular values of L₂ᵀ L₁.
  const Eigen::Matrix3d La = a.T.matrix3() * a.semi_axes.asDiagonal();
  const Eigen::Matrix3d Lb = b.T.matrix3() * b.semi_axes.asDiagonal();
  const Eigen::Matrix3d M = Lb.transpose() * La;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares(M.transpose() * M,
                                                               Eigen::EigenvaluesOnly);
  const double spread = a.semi_axes.squaredNorm() + b.semi_axes.squaredNorm();
  const double form =
      std::max(0.0, spread - 2 * squares.eigenvalues().cwiseMax(0).cwiseSqrt().sum());
  return std::sqrt((a.centre() - b.centre()).squaredNorm() + form);
}

}  // namespace cairn
