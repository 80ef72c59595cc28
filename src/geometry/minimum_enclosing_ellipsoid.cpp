#include "cairn/geometry/minimum_enclosing_ellipsoid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kDirections = 300;  // along each the outermost points matter
constexpr int kMaxSteps = 5000;

// Few points decide; those that are outermost in some direction are a good guess which.
std::vector<Vector3d> outermost(std::span<const Vector3d> points) {
  std::vector<std::size_t> chosen;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (i + 0.5) / kDirections, angle = 2.39996323 * i;
    const double r = std::sqrt(1 - z * z);
    const Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    std::size_t low = 0, high = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double along = direction.dot(points[k]);
      if (along < direction.dot(points[low])) low = k;
      if (along > direction.dot(points[high])) high = k;
    }
    chosen.push_back(low);
    chosen.push_back(high);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<Vector3d> result;
  for (const std::size_t k : chosen) result.push_back(points[k]);
  return result;
}

// Weights of the points in the dual problem: the D-optimal design.
VectorXd optimal_weights(const std::vector<Vector3d>& points, double tolerance) {
  const auto count = Eigen::Index(points.size());
  MatrixXd Q(4, count);
  for (Eigen::Index i = 0; i < count; ++i) Q.col(i) = points[std::size_t(i)].homogeneous();
  VectorXd weights = VectorXd::Constant(count, 1.0 / double(count));
  for (int step = 0; step < kMaxSteps; ++step) {
    const Matrix4d X = Q * weights.asDiagonal() * Q.transpose();
    const VectorXd level = (Q.array() * (X.inverse() * Q).array()).colwise().sum();
    Eigen::Index far = 0, near = -1;
    level.maxCoeff(&far);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (weights[i] > 0 && (near < 0 || level[i] < level[near])) near = i;
    }
    const double over = level[far] / 4 - 1, under = 1 - level[near] / 4;
    if (std::max(over, under) <= tolerance) break;
    const Eigen::Index moved = over >= under ? far : near;
    double share = (level[moved] - 4) / (4 * (level[moved] - 1));
    if (over < under) {
      const double least = -weights[moved] / (1 - weights[moved]);
      const bool drops = share <= least || level[moved] <= 1;
      if (drops) share = least;
      weights *= 1 - share;
      weights[moved] = drops ? 0 : weights[moved] + share;
    } else {
      weights *= 1 - share;
      weights[moved] += share;
    }
  }
  return weights;
}

// The permutation and signs of the axes that are nearest to the identity.
Matrix3d nearest_to_identity(const Matrix3d& axes, Vector3d& values) {
  std::array<int, 3> order = {0, 1, 2}, best = order;
  double best_sum = -1;
  do {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::abs(axes(i, order[std::size_t(i)]));
    if (sum > best_sum) best_sum = sum, best = order;
  } while (std::next_permutation(order.begin(), order.end()));
  Matrix3d R;
  const Vector3d old = values;
  for (int i = 0; i < 3; ++i) {
    R.col(i) = axes.col(best[std::size_t(i)]);
    if (R(i, i) < 0) R.col(i) = -R.col(i);
    values[i] = old[best[std::size_t(i)]];
  }
  if (R.determinant() < 0) {
    Eigen::Index weakest = 0;
    R.diagonal().cwiseAbs().minCoeff(&weakest);
    R.col(weakest) = -R.col(weakest);
  }
  return R;
}

}  // namespace

std::optional<EnclosingEllipsoid> minimum_enclosing_ellipsoid(std::span<const Vector3d> points,
                                                              double tolerance) {
  if (points.size() < 4) return std::nullopt;
  // In units of the cloud, around its middle: the numbers stay tame.
  Eigen::AlignedBox3d box;
  for (const Vector3d& X : points) box.extend(X);
  const Vector3d middle = box.center();
  const double scale = box.diagonal().norm() / 2;
  if (!(scale > 0)) return std::nullopt;
  std::vector<Vector3d> all;
  for (const Vector3d& X : points) all.emplace_back((X - middle) / scale);
  const std::vector<Vector3d> few = outermost(all);
  if (few.size() < 4) return std::nullopt;
  Matrix3d spread = Matrix3d::Zero();
  for (const Vector3d& X : few) spread += X * X.transpose();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& X : few) mean += X / double(few.size());
  spread -= double(few.size()) * mean * mean.transpose();
  if (Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvalues()[0] < 1e-10) return std::nullopt;

  const VectorXd weights = optimal_weights(few, tolerance);
  Vector3d centre = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (std::size_t i = 0; i < few.size(); ++i) {
    centre += weights[Eigen::Index(i)] * few[i];
    second += weights[Eigen::Index(i)] * few[i] * few[i].transpose();
  }
  // (x - c)' (3 S)^-1 (x - c) <= 1
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(3 * (second - centre * centre.transpose()));
  Vector3d axes = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
  EnclosingEllipsoid result;
  const Matrix3d R = nearest_to_identity(eigen.eigenvectors(), axes);
  result.rotation = Eigen::Quaterniond(R).normalized();
  result.centre = centre;
  result.semi_axes = axes;
  double outermost_level = 0;
  for (const Vector3d& X : all) outermost_level = std::max(outermost_level, result.level(X));
  result.semi_axes *= std::sqrt(outermost_level) * (1 + 1e-12) * scale;
  result.centre = middle + scale * centre;
  return result;
}

}  // namespace cairn
