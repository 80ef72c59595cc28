#include "cairn/geometry/resection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "cairn/geometry/p3p.h"
#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kHuber = 1.345;  // sigmas; 95 % efficiency for Gaussian noise

double squared_error(const Vector3d& X_c, const Vector2d& pixel, double sigma,
                     const Pinhole& camera) {
  if (!(X_c.z() > 0)) return INFINITY;
  return (camera.project(X_c) - pixel).squaredNorm() / (sigma * sigma);
}

// A pose and its evidence: the sum of gate - d² over the sightings under the gate.
struct ScoredPose {
  SE3 T_cw;
  double score = 0;
  int inliers = 0;
  std::vector<char> inlier;
};

class Resection {
 public:
  Resection(const Sightings& sightings, const Pinhole& camera, const ResectionOptions& options)
      : sightings_(sightings), camera_(camera), options_(options) {
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (sightings.points_w[i].allFinite() && sightings.pixels[i].allFinite() &&
          sightings.sigma_px(i) > 0) {
        valid_.push_back(static_cast<int>(i));
      }
    }
    best_.inlier.assign(sightings.size(), 0);
  }

  int valid_count() const { return static_cast<int>(valid_.size()); }
  const ScoredPose& best() const { return best_; }

  void search(std::uint64_t seed) {
    Sampler sampler(seed);
    int needed = options_.iterations;
    for (int i = 0; i < needed; ++i) {
      std::array<Vector3d, 3> rays, points;
      const auto drawn = sampler.distinct<3>(valid_count());
      for (int k = 0; k < 3; ++k) {
        const int index = valid_[drawn[k]];
        rays[k] = camera_.unproject(sightings_.pixels[index]);
        points[k] = sightings_.points_w[index];
      }
      const PoseCandidates candidates = p3p(rays, points);
      bool better = false;
      for (int k = 0; k < candidates.count; ++k) better |= consider(candidates.poses[k]);
      if (!better) continue;
      while (best_.inliers > 3 &&
             consider(refine_pose(best_.T_cw, sightings_, camera_, best_.inlier, 3))) {
      }
      needed = draws_needed();
    }
  }

  void polish() {
    for (int round = 0; round < 3 && best_.inliers > 3; ++round) {
      if (!consider(refine_pose(best_.T_cw, sightings_, camera_, best_.inlier,
                                options_.polish_iterations))) {
        return;
      }
    }
  }

  double rms() const {
    double sum = 0;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      if (best_.inlier[i]) {
        sum += squared_error(best_.T_cw * sightings_.points_w[i], sightings_.pixels[i],
                             sightings_.sigma_px(i), camera_);
      }
    }
    return std::sqrt(sum / std::max(best_.inliers, 1));
  }

 private:
  // Keeps the pose if it scores clearly higher than the best so far.
  bool consider(const SE3& T_cw) {
    const Matrix3d R = T_cw.matrix3();
    double score = 0;
    for (const int i : valid_) {
      const double d2 = squared_error(R * sightings_.points_w[i] + T_cw.translation(),
                                      sightings_.pixels[i], sightings_.sigma_px(i), camera_);
      if (d2 < options_.gate) score += options_.gate - d2;
    }
    if (!(score > best_.score * (1 + 1e-6))) return false;
    best_.T_cw = T_cw;
    best_.score = score;
    best_.inliers = 0;
    for (const int i : valid_) {
      best_.inlier[i] =
          squared_error(R * sightings_.points_w[i] + T_cw.translation(), sightings_.pixels[i],
                        sightings_.sigma_px(i), camera_) < options_.gate;
      best_.inliers += best_.inlier[i];
    }
    return true;
  }

  int draws_needed() const {
    const double clean = std::pow(double(best_.inliers) / valid_count(), 3);
    if (clean > 1 - 1e-9) return std::min(options_.min_iterations, options_.iterations);
    if (!(clean > 1e-9)) return options_.iterations;
    const double draws = std::log(1 - options_.confidence) / std::log(1 - clean);
    return static_cast<int>(std::min<double>(std::max<double>(draws + 1, options_.min_iterations),
                                             options_.iterations));
  }

  const Sightings& sightings_;
  const Pinhole& camera_;
  const ResectionOptions& options_;
  std::vector<int> valid_;
  ScoredPose best_;
};

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

// With `equations` off only the cost is summed. The update is exp(xi) * T_cw: in the camera's own
// frame the problem is well conditioned however far away the world's origin is.
NormalEquations linearize(const SE3& T_cw, const Sightings& sightings, const Pinhole& camera,
                          std::span<const char> use, bool equations) {
  NormalEquations sum;
  const Matrix3d R = T_cw.matrix3();
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!use[i]) continue;
    const Vector3d X = R * sightings.points_w[i] + T_cw.translation();
    const double sigma = sightings.sigma_px(i);
    if (!(X.z() > 0)) {
      sum.cost = INFINITY;  // no step may push a point behind the camera
      continue;
    }
    const Vector2d r = (camera.project(X) - sightings.pixels[i]) / sigma;
    const double length = r.norm();
    sum.cost += length <= kHuber ? 0.5 * length * length : kHuber * (length - 0.5 * kHuber);
    if (!equations) continue;
    const double weight = length <= kHuber ? 1.0 : kHuber / length;
    const double x = X.x() / X.z(), y = X.y() / X.z(), fx = camera.fx / sigma,
                 fy = camera.fy / sigma;
    Eigen::Matrix<double, 2, 6> J;
    J << fx / X.z(), 0, -fx * x / X.z(), -fx * x * y, fx * (1 + x * x), -fx * y, 0, fy / X.z(),
        -fy * y / X.z(), -fy * (1 + y * y), fy * x * y, fy * x;
    sum.H.noalias() += weight * J.transpose() * J;
    sum.g.noalias() += weight * J.transpose() * r;
  }
  return sum;
}

}  // namespace

SE3 refine_pose(const SE3& T_cw, const Sightings& sightings, const Pinhole& camera,
                std::span<const char> use, int iterations) {
  SE3 best = T_cw;
  double damping = 1e-6;
  NormalEquations sum = linearize(best, sightings, camera, use, true);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Matrix6d H = sum.H;
    H.diagonal() *= 1 + damping;
    const Vector6d step = H.ldlt().solve(-sum.g);
    if (!step.allFinite()) break;
    const SE3 next = SE3::exp(step) * best;
    const double cost = linearize(next, sightings, camera, use, false).cost;
    if (!(cost < sum.cost)) {
      damping *= 10;
      if (damping > 1e3) break;
      continue;
    }
    const bool converged = sum.cost - cost < 1e-9 * sum.cost;
    best = next;
    if (converged) break;
    damping *= 0.1;
    sum = linearize(best, sightings, camera, use, true);
  }
  return best;
}

ResectionResult resect(const Sightings& sightings, const Pinhole& camera,
                       const ResectionOptions& options, std::uint64_t seed) {
  assert(sightings.pixels.size() == sightings.size());
  assert(sightings.sigmas_px.empty() || sightings.sigmas_px.size() == sightings.size());
  ResectionResult result;
  result.inlier.assign(sightings.size(), 0);
  Resection problem(sightings, camera, options);
  const int needed = std::max(options.min_inliers, 4);
  if (problem.valid_count() < needed) {
    result.refusal = "only " + std::to_string(problem.valid_count()) + " points are seen; " +
                     std::to_string(needed) + " are needed";
    return result;
  }
  problem.search(seed);
  problem.polish();
  result.T_cw = problem.best().T_cw;
  result.inlier = problem.best().inlier;
  result.inliers = problem.best().inliers;
  result.rms_sigmas = problem.rms();
  result.usable = result.inliers >= needed;
  if (!result.usable) {
    result.refusal = "only " + std::to_string(result.inliers) + " of " +
                     std::to_string(sightings.size()) + " points agree with one pose; " +
                     std::to_string(needed) + " are needed";
  }
  return result;
}

}  // namespace cairn
