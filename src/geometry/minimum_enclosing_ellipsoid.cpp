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

// The least ellipsoid around few points, as exact as their weights are.
EnclosingEllipsoid ellipsoid_of(const std::vector<Vector3d>& points, const VectorXd& weights) {
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) centre += weights[Eigen::Index(i)] * points[i];
  Matrix3d second = Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d from_centre = points[i] - centre;
    second += weights[Eigen::Index(i)] * from_centre * from_centre.transpose();
  }
  // (x - c)' (3 S)^-1 (x - c) <= 1
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(3 * second);
  EnclosingEllipsoid result;
  result.centre = centre;
  result.semi_axes = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt();
  const Matrix3d R = nearest_to_identity(eigen.eigenvectors(), result.semi_axes);
  result.rotation = Eigen::Quaterniond(R).normalized();
  return result;
}

bool span_space(const std::vector<Vector3d>& points) {
  if (points.size() < 4) return false;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& X : points) mean += X / double(points.size());
  Matrix3d spread = Matrix3d::Zero();
  for (const Vector3d& X : points) spread += (X - mean) * (X - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvalues()[0] > 1e-10;
}

}  // namespace

std::optional<EnclosingEllipsoid> minimum_enclosing_ellipsoid(std::span<const Vector3d> points,
                                                              double tolerance) {
  if (points.empty()) return std::nullopt;
  // In units of the cloud, around its middle: the numbers stay tame.
  Eigen::AlignedBox3d box;
  for (const Vector3d& X : points) box.extend(X);
  const double scale = box.diagonal().norm() / 2;
  if (!(scale > 0)) return std::nullopt;
  std::vector<Vector3d> all;
  for (const Vector3d& X : points) all.emplace_back((X - box.center()) / scale);
  std::vector<Vector3d> few = outermost(all);
  if (!span_space(few)) return std::nullopt;
  while (true) {
    EnclosingEllipsoid result = ellipsoid_of(few, optimal_weights(few, tolerance));
    const auto farthest =
        std::ranges::max_element(all, {}, [&](const Vector3d& X) { return result.level(X); });
    const double level = result.level(*farthest);
    // One that was overlooked matters; one that is known cannot be helped by knowing it twice.
    if (level > 1 + 4 * tolerance && std::ranges::find(few, *farthest) == few.end()) {
      few.push_back(*farthest);
      continue;
    }
    result.semi_axes *= std::sqrt(std::max(level, 1.0)) * (1 + 1e-12) * scale;
    result.centre = box.center() + scale * result.centre;
    return result;
  }
}

}  // namespace cairn
