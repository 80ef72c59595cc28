#include "cairn/geometry/two_view.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "cairn/geometry/epipolar.h"
#include "cairn/geometry/homography.h"
#include "cairn/geometry/triangulation.h"
#include "cairn/geometry/two_view_models.h"

namespace cairn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Model = TwoViewResult::Model;

constexpr double kPointGate = 5.99;  // chi-square, 95 %, two degrees of freedom
constexpr double kDegree = M_PI / 180;
constexpr int kRefineSteps = 10;
constexpr double kSure = 6;  // by so much a motion costs less than any other, in squared sigmas

// What the matches say about one motion.
struct Votes {
  std::vector<Vector3d> points;
  std::vector<char> triangulated, agreeing;
  int triangulated_count = 0, agreeing_count = 0;
  double parallax = 0;  // radians
  double cost = 0;      // squared errors in sigmas, none above the gate: of all matches
};

struct Hypothesis {
  Model model = Model::kNone;
  SE3 T_21;
  Votes votes;

  bool better_than(const Hypothesis& other) const {
    if (votes.triangulated_count != other.votes.triangulated_count) {
      return votes.triangulated_count > other.votes.triangulated_count;
    }
    return votes.agreeing_count > other.votes.agreeing_count;
  }
};

struct Problem {
  std::vector<NormalizedMatch> matches;  // the finite ones
  std::vector<int> origin;               // their index in the caller's list
  Vector2d px;                           // focal lengths in sigmas
  TwoViewOptions options;
};

Problem prepare(std::span<const Vector2d> pixels1, std::span<const Vector2d> pixels2,
                const Pinhole& camera, const TwoViewOptions& options) {
  assert(pixels1.size() == pixels2.size());
  Problem problem;
  problem.options = options;
  problem.px = Vector2d(camera.fx, camera.fy) / options.sigma_px;
  for (std::size_t i = 0; i < std::min(pixels1.size(), pixels2.size()); ++i) {
    NormalizedMatch m;
    m << camera.unproject(pixels1[i]).head<2>(), camera.unproject(pixels2[i]).head<2>();
    // Beyond this a number is no ray of a camera, and its powers would overflow.
    if (!(m.cwiseAbs().maxCoeff() < 1e6) || !m.allFinite()) continue;
    problem.matches.push_back(m);
    problem.origin.push_back(static_cast<int>(i));
  }
  return problem;
}

double squared_error(const Vector3d& X, const Vector2d& x, const Vector2d& px) {
  return ((X.head<2>() / X.z() - x).array() * px.array()).matrix().squaredNorm();
}

Votes collect_votes(const Problem& problem, const SE3& T_21) {
  const std::size_t n = problem.matches.size();
  Votes votes;
  votes.points.assign(n, Vector3d::Zero());
  votes.triangulated.assign(n, 0);
  votes.agreeing.assign(n, 0);
  std::vector<double> parallaxes;
  parallaxes.reserve(n);
  const Eigen::Matrix3d R = T_21.matrix3();
  const Vector3d& t = T_21.translation();
  const double min_parallax = problem.options.min_point_parallax_deg * kDegree;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d x1 = problem.matches[i].head<2>(), x2 = problem.matches[i].tail<2>();
    const TwoRayPoint p = triangulate_two_rays(R, t, x1.homogeneous(), x2.homogeneous());
    const bool far = p.parallax < min_parallax;
    // The sign of a far point's depth is noise: its directions must agree, no more.
    const Vector3d X1 = far && !p.in_front() ? Vector3d(x1.homogeneous()) : p.point;
    const Vector3d X2 = far && !p.in_front() ? Vector3d(R * X1) : Vector3d(R * X1 + t);
    const double e1 = squared_error(X1, x1, problem.px), e2 = squared_error(X2, x2, problem.px);
    const bool agrees =
        (far || p.in_front()) && X1.z() > 0 && X2.z() > 0 && e1 < kPointGate && e2 < kPointGate;
    votes.cost += agrees ? e1 + e2 : 2 * kPointGate;
    if (!agrees) continue;
    votes.agreeing[i] = 1;
    ++votes.agreeing_count;
    parallaxes.push_back(p.parallax);
    if (far) continue;
    votes.points[i] = p.point;
    votes.triangulated[i] = 1;
    ++votes.triangulated_count;
  }
  if (parallaxes.empty()) return votes;
  const std::size_t rank = std::min<std::size_t>(
      std::max<std::size_t>(std::max(problem.options.min_points, 1), parallaxes.size() / 3) - 1,
      parallaxes.size() - 1);
  std::nth_element(parallaxes.begin(), parallaxes.begin() + rank, parallaxes.end(),
                   std::greater<>());
  votes.parallax = parallaxes[rank];
  return votes;
}

std::vector<Hypothesis> hypotheses(const Problem& problem, std::uint64_t seed) {
  RansacOptions ransac;
  ransac.iterations = problem.options.iterations;
  const ScoredModel E = estimate_essential(problem.matches, problem.px, ransac, seed);
  const ScoredModel H =
      estimate_homography(problem.matches, problem.px, ransac, seed ^ 0x9e3779b97f4a7c15ull);
  std::vector<Hypothesis> all;
  if (E.score > 0) {
    for (const SE3& T_21 : decompose_essential(E.matrix)) {
      all.push_back({Model::kEssential, T_21, collect_votes(problem, T_21)});
    }
  }
  if (!(H.score > problem.options.homography_share * (H.score + E.score))) return all;
  const HomographyMotions plane = decompose_homography(H.matrix);
  for (int i = 0; i < plane.count; ++i) {
    const SE3 T_21 =
        refine_motion(plane.motions[i], problem.matches, H.inliers, problem.px, kRefineSteps);
    all.push_back({Model::kHomography, T_21, collect_votes(problem, T_21)});
  }
  return all;
}

// Two hypotheses that came to the same motion on different ways are no rivals.
bool same_motion(const SE3& a, const SE3& b) {
  return a.rotation().angularDistance(b.rotation()) < 1.0 * kDegree &&
         a.translation().dot(b.translation()) > std::cos(10.0 * kDegree);
}

// The rotation that takes the directions of the first view to those of the second (Kabsch).
Eigen::Quaterniond mean_rotation(const Problem& problem, std::span<const char> agreeing) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < problem.matches.size(); ++i) {
    if (!agreeing[i]) continue;
    const NormalizedMatch& m = problem.matches[i];
    sum +=
        m.tail<2>().homogeneous().normalized() * m.head<2>().homogeneous().normalized().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = svd.matrixU();
  turn.col(2) *= (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return Eigen::Quaterniond(turn * svd.matrixV().transpose());
}

// Where depths differ little, a motion to the side with a turn looks like one ahead. Of the other
// motions that a search from the six directions finds, the one that explains the matches best.
Hypothesis best_other(const Problem& problem, const Hypothesis& best) {
  const Eigen::Quaterniond R = mean_rotation(problem, best.votes.agreeing);
  Hypothesis other;
  other.votes.cost = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const SE3 motion = refine_motion(SE3(R, sign * Vector3d::Unit(axis)), problem.matches,
                                       best.votes.agreeing, problem.px, kRefineSteps);
      if (same_motion(motion, best.T_21)) continue;
      Votes votes = collect_votes(problem, motion);
      if (votes.cost < other.votes.cost) other = {best.model, motion, std::move(votes)};
    }
  }
  return other;
}

template <typename... Values>
std::string sentence(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string why_not(const Problem& problem, const Votes& best, int rival, double other,
                    std::size_t matches) {
  const TwoViewOptions& options = problem.options;
  if (best.agreeing_count < options.min_points) {
    return sentence("only %d of %zu matches agree with one motion; %d are needed",
                    best.agreeing_count, matches, options.min_points);
  }
  if (best.parallax < options.min_parallax_deg * kDegree) {
    return sentence("the parallax of %.2f degrees is too small; move sideways",
                    best.parallax / kDegree);
  }
  if (best.triangulated_count < options.min_points) {
    return sentence("only %d of %zu matches have a depth; %d are needed", best.triangulated_count,
                    matches, options.min_points);
  }
  if (rival > options.max_rival_share * best.triangulated_count) {
    return sentence("two motions explain the matches about equally well (%d and %d points)",
                    best.triangulated_count, rival);
  }
  if (other < best.cost + kSure) return "two motions explain the matches about equally well";
  return {};
}

}  // namespace

TwoViewResult reconstruct_two_views(std::span<const Vector2d> pixels1,
                                    std::span<const Vector2d> pixels2, const Pinhole& camera,
                                    const TwoViewOptions& options, std::uint64_t seed) {
  TwoViewResult result;
  result.points.assign(pixels1.size(), Vector3d::Zero());
  result.triangulated.assign(pixels1.size(), 0);
  const Problem problem = prepare(pixels1, pixels2, camera, options);
  const int needed = std::max(options.min_points, 8);
  if (static_cast<int>(problem.matches.size()) < needed) {
    result.refusal = sentence("only %zu matches; %d are needed", problem.matches.size(), needed);
    return result;
  }

  const std::vector<Hypothesis> all = hypotheses(problem, seed);
  if (all.empty()) {
    result.refusal = "no motion explains the matches";
    return result;
  }
  Hypothesis best =
      *std::min_element(all.begin(), all.end(),
                        [](const Hypothesis& a, const Hypothesis& b) { return a.better_than(b); });
  int rival = 0;
  for (const Hypothesis& other : all) {
    if (!same_motion(other.T_21, best.T_21)) {
      rival = std::max(rival, other.votes.triangulated_count);
    }
  }
  const SE3 refined =
      refine_motion(best.T_21, problem.matches, best.votes.agreeing, problem.px, kRefineSteps);
  Hypothesis polished{best.model, refined, collect_votes(problem, refined)};
  if (!best.better_than(polished)) best = std::move(polished);

  Hypothesis other = best_other(problem, best);
  if (other.votes.cost < best.votes.cost) std::swap(best, other);
  result.refusal = why_not(problem, best.votes, rival, other.votes.cost, pixels1.size());
  result.usable = result.refusal.empty();
  result.model = best.model;
  result.T_21 = best.T_21;
  result.parallax_deg = best.votes.parallax / kDegree;
  result.inliers = best.votes.agreeing_count;
  for (std::size_t i = 0; i < problem.matches.size(); ++i) {
    result.points[problem.origin[i]] = best.votes.points[i];
    result.triangulated[problem.origin[i]] = best.votes.triangulated[i];
  }
  return result;
}

}  // namespace cairn
