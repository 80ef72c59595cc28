#include "cairn/geometry/two_view_models.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cairn/geometry/five_point.h"
#include "cairn/geometry/homography.h"
#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Chi-square, 95 %: a point's distance to a line (1 degree of freedom) and to a point (2).
constexpr double kLineGate = 3.84, kPointGate = 5.99;

// Calls visit(i, d², d²) with the squared distances, in sigmas, to the epipolar lines in the first
// and in the second picture.
template <typename Visit>
void visit_line_distances(const Matrix3d& E, std::span<const NormalizedMatch> matches,
                          const Vector2d& px, const Visit& visit) {
  const double wx = 1 / (px.x() * px.x()), wy = 1 / (px.y() * px.y());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double x1 = matches[i][0], y1 = matches[i][1], x2 = matches[i][2], y2 = matches[i][3];
    const double a0 = E(0, 0) * x1 + E(0, 1) * y1 + E(0, 2);
    const double a1 = E(1, 0) * x1 + E(1, 1) * y1 + E(1, 2);
    const double a2 = E(2, 0) * x1 + E(2, 1) * y1 + E(2, 2);
    const double b0 = E(0, 0) * x2 + E(1, 0) * y2 + E(2, 0);
    const double b1 = E(0, 1) * x2 + E(1, 1) * y2 + E(2, 1);
    const double e = x2 * a0 + y2 * a1 + a2, e2 = e * e;
    visit(i, e2 / (wx * b0 * b0 + wy * b1 * b1), e2 / (wx * a0 * a0 + wy * a1 * a1));
  }
}

// The same for the distances to the point that H, or its inverse, predicts.
template <typename Visit>
void visit_point_distances(const Matrix3d& H, std::span<const NormalizedMatch> matches,
                           const Vector2d& px, const Visit& visit) {
  const Matrix3d G = H.inverse();
  const double wx = px.x() * px.x(), wy = px.y() * px.y();
  const auto distance = [&](const Matrix3d& M, double x, double y, double u, double v) {
    const double w = 1 / (M(2, 0) * x + M(2, 1) * y + M(2, 2));
    const double dx = (M(0, 0) * x + M(0, 1) * y + M(0, 2)) * w - u;
    const double dy = (M(1, 0) * x + M(1, 1) * y + M(1, 2)) * w - v;
    return wx * dx * dx + wy * dy * dy;
  };
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const NormalizedMatch& m = matches[i];
    visit(i, distance(G, m[2], m[3], m[0], m[1]), distance(H, m[0], m[1], m[2], m[3]));
  }
}

struct Essential {
  static constexpr int kSample = 5;

  static double score(const Matrix3d& E, std::span<const NormalizedMatch> matches,
                      const Vector2d& px) {
    double sum = 0;
    visit_line_distances(E, matches, px, [&](std::size_t, double d1, double d2) {
      if (d1 < kLineGate) sum += kPointGate - d1;
      if (d2 < kLineGate) sum += kPointGate - d2;
    });
    return sum;
  }
  static void mark(const Matrix3d& E, std::span<const NormalizedMatch> matches, const Vector2d& px,
                   std::vector<char>& inliers) {
    visit_line_distances(E, matches, px, [&](std::size_t i, double d1, double d2) {
      inliers[i] = d1 < kLineGate && d2 < kLineGate;
    });
  }
  template <typename Try>
  static void solve(std::span<const NormalizedMatch> matches, Sampler& sampler,
                    const Try& attempt) {
    const auto drawn = sampler.distinct<kSample>(static_cast<int>(matches.size()));
    std::array<Vector3d, kSample> rays1, rays2;
    for (int i = 0; i < kSample; ++i) {
      rays1[i] = matches[drawn[i]].head<2>().homogeneous();
      rays2[i] = matches[drawn[i]].tail<2>().homogeneous();
    }
    const EssentialCandidates candidates = five_point(rays1, rays2);
    for (int i = 0; i < candidates.count; ++i) attempt(candidates.matrices[i]);
  }
  static Matrix3d refit(const Matrix3d& E, std::span<const NormalizedMatch> matches,
                        std::span<const char> inliers, const Vector2d& px, int iterations) {
    // All four motions of E share its Sampson errors.
    const SE3 motion = decompose_essential(E)[0];
    return essential_matrix(refine_motion(motion, matches, inliers, px, iterations));
  }
};

struct Homography {
  static constexpr int kSample = 4;

  static double score(const Matrix3d& H, std::span<const NormalizedMatch> matches,
                      const Vector2d& px) {
    double sum = 0;
    visit_point_distances(H, matches, px, [&](std::size_t, double d1, double d2) {
      if (d1 < kPointGate) sum += kPointGate - d1;
      if (d2 < kPointGate) sum += kPointGate - d2;
    });
    return sum;
  }
  static void mark(const Matrix3d& H, std::span<const NormalizedMatch> matches, const Vector2d& px,
                   std::vector<char>& inliers) {
    visit_point_distances(H, matches, px, [&](std::size_t i, double d1, double d2) {
      inliers[i] = d1 < kPointGate && d2 < kPointGate;
    });
  }
  template <typename Try>
  static void solve(std::span<const NormalizedMatch> matches, Sampler& sampler,
                    const Try& attempt) {
    const auto drawn = sampler.distinct<kSample>(static_cast<int>(matches.size()));
    attempt(fit_homography(
        {matches[drawn[0]], matches[drawn[1]], matches[drawn[2]], matches[drawn[3]]}));
  }
  static Matrix3d refit(const Matrix3d&, std::span<const NormalizedMatch> matches,
                        std::span<const char> inliers, const Vector2d&, int) {
    return fit_homography(matches, inliers);
  }
};

template <typename Model>
void remark(std::span<const NormalizedMatch> matches, const Vector2d& px, ScoredModel& model) {
  model.inliers.assign(matches.size(), 0);
  Model::mark(model.matrix, matches, px, model.inliers);
  model.inlier_count =
      static_cast<int>(std::count(model.inliers.begin(), model.inliers.end(), char(1)));
}

// Replaces the model by its refit on its own inliers as long as the score grows.
template <typename Model>
void optimize_locally(std::span<const NormalizedMatch> matches, const Vector2d& px, int rounds,
                      int iterations, ScoredModel& model) {
  for (int round = 0; round < rounds && model.inlier_count > Model::kSample; ++round) {
    const Matrix3d refit = Model::refit(model.matrix, matches, model.inliers, px, iterations);
    const double score = Model::score(refit, matches, px);
    if (!(score > model.score)) return;
    model.matrix = refit;
    model.score = score;
    remark<Model>(matches, px, model);
  }
}

// Draws after which one sample was free of outliers with the confidence asked for.
int draws_needed(double inlier_share, int sample, const RansacOptions& options) {
  const double clean = std::pow(inlier_share, sample);
  if (!(clean > 1e-9)) return options.iterations;
  if (clean > 1 - 1e-9) return options.min_iterations;
  const double draws = std::log(1 - options.confidence) / std::log(1 - clean);
  return static_cast<int>(
      std::clamp<double>(draws + 1, options.min_iterations, options.iterations));
}

template <typename Model>
ScoredModel estimate(std::span<const NormalizedMatch> matches, const Vector2d& px,
                     const RansacOptions& options, std::uint64_t seed) {
  ScoredModel best;
  best.inliers.assign(matches.size(), 0);
  if (matches.size() < Model::kSample) return best;
  Sampler sampler(seed);
  int needed = options.iterations;
  for (int i = 0; i < needed; ++i) {
    Model::solve(matches, sampler, [&](const Matrix3d& candidate) {
      const double score = Model::score(candidate, matches, px);
      if (!(score > best.score)) return;
      best.matrix = candidate;
      best.score = score;
      remark<Model>(matches, px, best);
      optimize_locally<Model>(matches, px, 2, 3, best);
      needed = draws_needed(double(best.inlier_count) / matches.size(), Model::kSample, options);
    });
  }
  optimize_locally<Model>(matches, px, 5, 10, best);
  return best;
}

}  // namespace

ScoredModel estimate_essential(std::span<const NormalizedMatch> matches, const Vector2d& px,
                               const RansacOptions& options, std::uint64_t seed) {
  return estimate<Essential>(matches, px, options, seed);
}

ScoredModel estimate_homography(std::span<const NormalizedMatch> matches, const Vector2d& px,
                                const RansacOptions& options, std::uint64_t seed) {
  return estimate<Homography>(matches, px, options, seed);
}

}  // namespace cairn
