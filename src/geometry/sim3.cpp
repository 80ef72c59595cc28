#include "cairn/geometry/sim3.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The integral of exp(tau sigma) Exp(tau omega) over tau from 0 to 1: a I + b [omega]x + c
// [omega]x². With Rodrigues' formula a, b and c are integrals of exp(sigma tau) times 1,
// sin(theta tau) / theta and (1 - cos(theta tau)) / theta².
Matrix3d translation_jacobian(const Vector3d& omega, double sigma) {
  const double theta2 = omega.squaredNorm(), theta = std::sqrt(theta2);
  const double s2 = sigma * sigma, radius2 = s2 + theta2;
  const double a = std::abs(sigma) < 1e-12 ? 1 : std::expm1(sigma) / sigma;
  double b, c;
  if (radius2 < 1e-6) {  // Taylor's series of both
    b = 1 / 2. + sigma / 3 + s2 / 8 + s2 * sigma / 30 - theta2 / 24 - theta2 * sigma / 30;
    c = 1 / 6. + sigma / 8 + s2 / 20 + s2 * sigma / 72 - theta2 / 120 - theta2 * sigma / 144;
  } else {
    const double e = std::exp(sigma), sine = std::sin(theta), cosine = std::cos(theta);
    const double with_cos = (e * (sigma * cosine + theta * sine) - sigma) / radius2;
    const double with_sin = (e * (sigma * sine - theta * cosine) + theta) / radius2;
    // Without rotation [omega]x is zero, and so is what b and c are for.
    b = theta > 1e-12 ? with_sin / theta : 0;
    c = theta > 1e-12 ? (a - with_cos) / theta2 : 0;
  }
  const Matrix3d W = skew(omega);
  return a * Matrix3d::Identity() + b * W + c * W * W;
}

}  // namespace

Eigen::Matrix4d Sim3::matrix() const {
  Eigen::Matrix4d M = Eigen::Matrix4d::Identity();
  M.topLeftCorner<3, 3>() = s_ * matrix3();
  M.topRightCorner<3, 1>() = t_;
  return M;
}

Sim3 Sim3::inverse() const {
  const Eigen::Quaterniond qi = q_.conjugate();
  return Sim3(1 / s_, qi, -(qi * t_) / s_);
}

Sim3 Sim3::exp(const Vector7d& xi) {
  const Vector3d omega = xi.segment<3>(3);
  return Sim3(std::exp(xi[6]), so3_exp(omega), translation_jacobian(omega, xi[6]) * xi.head<3>());
}

Vector7d Sim3::log() const {
  Vector7d xi;
  const Vector3d omega = so3_log(q_);
  const double sigma = std::log(s_);
  xi << translation_jacobian(omega, sigma).inverse() * t_, omega, sigma;
  return xi;
}

SimilarityFit align_umeyama(std::span<const Vector3d> from, std::span<const Vector3d> to,
                            bool with_scale, double min_flatness) {
  SimilarityFit result;
  const auto refuse = [&](const std::string& why) {
    result.refusal = why;
    return result;
  };
  if (from.size() != to.size()) {
    return refuse("the two sets have " + std::to_string(from.size()) + " and " +
                  std::to_string(to.size()) + " points; they must match one to one");
  }
  if (from.size() < 3) {
    return refuse("only " + std::to_string(from.size()) + " points to align; 3 are needed");
  }
  const double n = static_cast<double>(from.size());
  Vector3d mean_from = Vector3d::Zero(), mean_to = Vector3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    mean_from += from[i] / n;
    mean_to += to[i] / n;
  }
  Matrix3d cross = Matrix3d::Zero();
  double variance_from = 0, variance_to = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vector3d a = from[i] - mean_from, b = to[i] - mean_to;
    cross += b * a.transpose() / n;
    variance_from += a.squaredNorm() / n;
    variance_to += b.squaredNorm() / n;
  }
  if (!cross.allFinite() || !std::isfinite(variance_from + variance_to)) {
    return refuse("a coordinate of the points to align is not finite");
  }
  if (!(std::sqrt(variance_from) > 1e-12 * (1 + mean_from.norm())) ||
      !(std::sqrt(variance_to) > 1e-12 * (1 + mean_to.norm()))) {
    return refuse("the points to align lie in one place");
  }
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > min_flatness * svd.singularValues()[0])) {
    return refuse("the points to align lie on one line, so their rotation is not defined");
  }
  Vector3d sign(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  const Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const double scale = with_scale ? svd.singularValues().dot(sign) / variance_from : 1.0;
  if (!(scale > 0)) return refuse("the two sets of points have no similar shape");
  result.transform = Sim3(scale, R, mean_to - scale * R * mean_from);
  double squares = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    squares += (result.transform * from[i] - to[i]).squaredNorm();
  }
  result.rmse = std::sqrt(squares / n);
  result.usable = true;
  return result;
}

}  // namespace cairn
