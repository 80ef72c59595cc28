#include "cairn/geometry/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Points on one line: their spread across it, squared, is less than this share of that along it.
constexpr double kMinFlatness = 1e-10;

// Points with weights, of which those that cannot be used have none.
class WeightedPoints {
 public:
  WeightedPoints(std::span<const Vector3d> points, std::span<const double> weights)
      : points_(points), weights_(points.size(), 1.0) {
    assert(weights.empty() || weights.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!weights.empty()) weights_[i] = weights[i];
      if (!points[i].allFinite() || !(weights_[i] >= 0) || !std::isfinite(weights_[i])) {
        weights_[i] = 0;
        all_finite_ = false;
      }
      if (weights_[i] > 0) valid_.push_back(i);
    }
  }

  std::size_t size() const { return points_.size(); }
  bool all_finite() const { return all_finite_; }
  const std::vector<std::size_t>& valid() const { return valid_; }
  const Vector3d& point(std::size_t i) const { return points_[i]; }
  double weight(std::size_t i) const { return weights_[i]; }
  // Weighted and squared.
  double squared_distance(const Plane::Hessian& plane, std::size_t i) const {
    const double distance = plane.head<3>().dot(points_[i]) + plane[3];
    return weights_[i] * distance * distance;
  }

 private:
  std::span<const Vector3d> points_;
  std::vector<double> weights_;
  std::vector<std::size_t> valid_;
  bool all_finite_ = true;
};

struct Moments {
  double weight = 0;
  int count = 0;
  Vector3d mean = Vector3d::Zero();
  Matrix3d scatter = Matrix3d::Zero();  // mean of (x - mean)(x - mean)ᵀ
};

// `weight_of` gives the weight that the point of an index takes part with.
template <typename WeightOf>
Moments moments(const WeightedPoints& points, const WeightOf& weight_of) {
  Moments m;
  for (const std::size_t i : points.valid()) {
    const double w = weight_of(i);
    m.weight += w;
    m.count += w > 0;
    m.mean += w * points.point(i);
  }
  if (!(m.weight > 0)) return m;
  m.mean /= m.weight;
  for (const std::size_t i : points.valid()) {
    const Vector3d x = points.point(i) - m.mean;
    m.scatter.noalias() += (weight_of(i) / m.weight) * x * x.transpose();
  }
  return m;
}

// None where the points lie on one line.
std::optional<Plane> best_plane(const Moments& m) {
  if (m.count < 3) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(m.scatter);
  const Vector3d& spread = solver.eigenvalues();  // increasing
  if (!(spread[1] > kMinFlatness * spread[2])) return std::nullopt;
  const Vector3d normal = solver.eigenvectors().col(0);
  const double offset = -normal.dot(m.mean);
  return Plane::from_coefficients({normal.x(), normal.y(), normal.z(), offset});
}

// Fills in what the inliers, whose moments `m` are, say about their plane.
void describe(const Plane& plane, const Moments& m, PlaneFit& fit) {
  fit.plane = plane.facing_origin();
  const Vector3d n = fit.plane.normal();
  const double off = fit.plane.signed_distance(m.mean);
  fit.centroid = m.mean - off * n;
  fit.inliers = m.count;
  const double squared = std::max(n.dot(m.scatter * n) + off * off, 0.0);
  fit.rms = std::sqrt(squared);
  // Linear regression of the distances on the two coordinates in the plane.
  const double noise = squared * m.weight / std::max(m.count - 3, 1);
  const Eigen::Matrix<double, 3, 2> axes = tangent_axes(n);
  const Eigen::Matrix2d spread = axes.transpose() * m.scatter * axes;
  fit.covariance.setZero();
  fit.covariance.topLeftCorner<2, 2>() = noise / m.weight * spread.inverse();
  fit.covariance(2, 2) = noise / m.weight;
  fit.usable = fit.covariance.allFinite() && fit.centroid.allFinite();
  if (!fit.usable) fit.refusal = "the points do not spread over a plane";
}

PlaneFit refused(PlaneFit fit, std::string sentence) {
  fit.usable = false;
  fit.refusal = std::move(sentence);
  return fit;
}

class RobustFit {
 public:
  RobustFit(const WeightedPoints& points, const PlaneFitOptions& options)
      : points_(points), options_(options), gate_(options.max_distance * options.max_distance) {}

  void search(std::uint64_t seed) {
    Sampler sampler(seed);
    const int count = static_cast<int>(points_.valid().size());
    int needed = options_.iterations;
    for (int i = 0; i < needed; ++i) {
      const auto drawn = sampler.distinct<3>(count);
      const auto corner = [&](int k) { return points_.point(points_.valid()[drawn[k]]); };
      const Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
      const Vector3d normal = a.cross(b);
      if (!(normal.norm() > 1e-6 * a.norm() * b.norm())) continue;  // on one line
      consider(Plane::through(corner(0), normal.normalized()));
      needed = draws_needed(count);
    }
  }

  // Tukey's weights fall to zero at the gate, so the fit does not hang on who is just inside.
  void polish() {
    for (int i = 0; i < options_.polish_iterations && found_; ++i) {
      const Plane::Hessian h = best_.hessian();
      const auto plane = best_plane(moments(points_, [&](std::size_t k) {
        const double rest = std::max(1 - points_.squared_distance(h, k) / gate_, 0.0);
        return points_.weight(k) * rest * rest;
      }));
      if (!plane) return;
      const bool converged = best_.log(*plane).norm() < 1e-12;
      best_ = *plane;
      if (converged) return;
    }
  }

  PlaneFit result() const {
    PlaneFit fit;
    fit.inlier.assign(points_.size(), 0);
    if (!found_) return refused(fit, "no three points span a plane");
    const Plane::Hessian h = best_.hessian();
    for (const std::size_t i : points_.valid()) {
      fit.inlier[i] = points_.squared_distance(h, i) < gate_;
    }
    const Moments m =
        moments(points_, [&](std::size_t k) { return fit.inlier[k] ? points_.weight(k) : 0.0; });
    fit.inliers = m.count;
    const int needed = std::max(options_.min_inliers, 3);
    if (m.count < needed) {
      return refused(fit, "only " + std::to_string(m.count) + " of " +
                              std::to_string(points_.size()) + " points lie on one plane; " +
                              std::to_string(needed) + " are needed");
    }
    if (!best_plane(m)) return refused(fit, "the points lie on one line");
    describe(best_, m, fit);
    return fit;
  }

 private:
  void consider(const Plane& plane) {
    const Plane::Hessian h = plane.hessian();
    double score = 0;
    int inliers = 0;
    for (const std::size_t i : points_.valid()) {
      const double rest = gate_ - points_.squared_distance(h, i);
      if (!(rest > 0)) continue;
      score += rest;
      ++inliers;
    }
    if (!(score > score_)) return;
    score_ = score;
    inliers_ = inliers;
    best_ = plane;
    found_ = true;
  }

  int draws_needed(int count) const {
    const double clean = std::pow(double(inliers_) / count, 3);
    if (clean > 1 - 1e-9) return std::min(options_.min_iterations, options_.iterations);
    if (!(clean > 1e-9)) return options_.iterations;
    const double draws = std::log(1 - options_.confidence) / std::log(1 - clean);
    return static_cast<int>(std::min<double>(std::max<double>(draws + 1, options_.min_iterations),
                                             options_.iterations));
  }

  const WeightedPoints& points_;
  const PlaneFitOptions& options_;
  double gate_;
  Plane best_;
  double score_ = 0;
  int inliers_ = 0;
  bool found_ = false;
};

}  // namespace

std::string PlaneFit::to_string() const {
  if (!usable) return "no plane: " + refusal;
  char text[160];
  std::snprintf(text, sizeof text, "plane of %d points: rms %.4g, sigma %.3g deg and %.3g", inliers,
                rms, std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2) * 180 / M_PI,
                std::sqrt(covariance(2, 2)));
  return text;
}

PlaneFit fit_plane(std::span<const Vector3d> points, std::span<const double> weights) {
  const WeightedPoints weighted(points, weights);
  PlaneFit fit;
  fit.inlier.assign(points.size(), 0);
  if (!weighted.all_finite()) return refused(fit, "a point or a weight is not a finite number");
  if (weighted.valid().size() < 3) {
    return refused(fit, "only " + std::to_string(weighted.valid().size()) +
                            " points have a weight; 3 are needed");
  }
  const Moments m = moments(weighted, [&](std::size_t i) { return weighted.weight(i); });
  const std::optional<Plane> plane = best_plane(m);
  if (!plane) return refused(fit, "the points lie on one line");
  for (const std::size_t i : weighted.valid()) fit.inlier[i] = 1;
  describe(*plane, m, fit);
  return fit;
}

PlaneFit fit_plane_robustly(std::span<const Vector3d> points, std::span<const double> weights,
                            const PlaneFitOptions& options, std::uint64_t seed) {
  const WeightedPoints weighted(points, weights);
  RobustFit robust(weighted, options);
  if (weighted.valid().size() >= 3) robust.search(seed);
  robust.polish();
  return robust.result();
}

}  // namespace cairn
