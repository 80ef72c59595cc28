#include "cairn/geometry/epipolar.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Row3 = Eigen::RowVector3d;
using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

constexpr double kHuber = 1.345;  // sigmas; 95 % efficiency for Gaussian noise

double huber_cost(double r) {
  const double a = std::abs(r);
  return a <= kHuber ? 0.5 * r * r : kHuber * (a - 0.5 * kHuber);
}

// Two unit vectors that span the tangent plane of the sphere at t.
Eigen::Matrix<double, 3, 2> tangent_basis(const Vector3d& t) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = t.unitOrthogonal();
  basis.col(1) = t.cross(basis.col(0));
  return basis;
}

struct NormalEquations {
  Matrix5d H = Matrix5d::Zero();
  Vector5d g = Vector5d::Zero();
  double cost = 0;
};

// The Sampson error r = e / s, e = x2ᵀ E x1, s² = |W a|² + |W b|² with a = (E x1), b = (Eᵀ x2) cut
// to their first two entries and W = diag(1/px): the error's first-order standard deviation.
// The update is R Exp(omega), t + basis * delta.
class SampsonError {
 public:
  SampsonError(const Matrix3d& R, const Vector3d& t, const Vector2d& px)
      : R_(R), E_(skew(t) * R), basis_(tangent_basis(t)), w_(px.cwiseInverse().cwiseAbs2()) {}

  double error(const NormalizedMatch& m) const {
    const Vector3d x1(m[0], m[1], 1), x2(m[2], m[3], 1);
    const Vector3d a = E_ * x1, b = E_.transpose() * x2;
    return x2.dot(a) / std::sqrt(variance(a, b));
  }

  void accumulate(const NormalizedMatch& m, NormalEquations& sum) const {
    const Vector3d x1(m[0], m[1], 1), x2(m[2], m[3], 1);
    const Vector3d a = E_ * x1, b = E_.transpose() * x2, y = R_ * x1;
    const double e = x2.dot(a), s2 = variance(a, b), s = std::sqrt(s2), r = e / s;
    if (!std::isfinite(r)) return;
    // Half the gradient of s², then its chain through da and db.
    const Row3 ga(w_[0] * a[0], w_[1] * a[1], 0), gb(w_[0] * b[0], w_[1] * b[1], 0);
    const Row3 de_omega = x1.cross(b).transpose();
    const Row3 de_t = y.cross(x2).transpose();
    const Row3 dh_omega = -(ga * E_) * skew(x1) + gb * skew(b);
    const Row3 dh_t = -ga * skew(y) + (gb * R_.transpose()) * skew(x2);
    Vector5d J;
    J.head<3>() = ((de_omega - (e / s2) * dh_omega) / s).transpose();
    J.tail<2>() = (((de_t - (e / s2) * dh_t) / s) * basis_).transpose();
    const double weight = std::abs(r) <= kHuber ? 1.0 : kHuber / std::abs(r);
    sum.H.noalias() += weight * J * J.transpose();
    sum.g.noalias() += weight * r * J;
    sum.cost += huber_cost(r);
  }

  const Eigen::Matrix<double, 3, 2>& basis() const { return basis_; }

 private:
  double variance(const Vector3d& a, const Vector3d& b) const {
    return w_[0] * (a[0] * a[0] + b[0] * b[0]) + w_[1] * (a[1] * a[1] + b[1] * b[1]);
  }

  Matrix3d R_, E_;
  Eigen::Matrix<double, 3, 2> basis_;
  Vector2d w_;
};

double total_cost(const SampsonError& model, std::span<const NormalizedMatch> matches,
                  std::span<const char> inliers) {
  double cost = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!inliers[i]) continue;
    const double r = model.error(matches[i]);
    if (std::isfinite(r)) cost += huber_cost(r);
  }
  return cost;
}

}  // namespace

Matrix3d essential_matrix(const SE3& T_21) { return skew(T_21.translation()) * T_21.matrix3(); }

std::array<SE3, 4> decompose_essential(const Matrix3d& E) {
  const Eigen::JacobiSVD<Matrix3d> svd(E, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d U = svd.matrixU(), V = svd.matrixV();
  if (U.determinant() < 0) U.col(2) *= -1;
  if (V.determinant() < 0) V.col(2) *= -1;
  Matrix3d W;
  W << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Matrix3d Ra = U * W * V.transpose(), Rb = U * W.transpose() * V.transpose();
  const Vector3d t = U.col(2);
  return {SE3(Ra, t), SE3(Ra, -t), SE3(Rb, t), SE3(Rb, -t)};
}

SE3 refine_motion(const SE3& T_21, std::span<const NormalizedMatch> matches,
                  std::span<const char> inliers, const Vector2d& px, int iterations) {
  SE3 best(T_21.rotation(), T_21.translation().normalized());
  double damping = 1e-4;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const SampsonError model(best.matrix3(), best.translation(), px);
    NormalEquations sum;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (inliers[i]) model.accumulate(matches[i], sum);
    }
    Matrix5d H = sum.H;
    H.diagonal() *= 1 + damping;
    H.diagonal().array() += 1e-12;
    const Vector5d step = H.ldlt().solve(-sum.g);
    if (!step.allFinite()) break;
    const SE3 next(best.rotation() * so3_exp(step.head<3>()),
                   (best.translation() + model.basis() * step.tail<2>()).normalized());
    const double cost =
        total_cost(SampsonError(next.matrix3(), next.translation(), px), matches, inliers);
    if (!(cost < sum.cost)) {
      damping *= 10;
      if (damping > 1e3) break;
      continue;
    }
    best = next;
    damping *= 0.1;
    if (sum.cost - cost < 1e-6 * sum.cost || step.squaredNorm() < 1e-20) break;
  }
  return best;
}

}  // namespace cairn
