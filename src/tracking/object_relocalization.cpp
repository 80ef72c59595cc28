#include "cairn/tracking/object_relocalization.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/p3p.h"
#include "cairn/map/object_classes.h"

namespace cairn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Three = std::array<int, 3>;

constexpr int kLeastAgreeing = 3;
constexpr int kSurelyAgreeing = 4;  // three centres always have a pose that fits; a fourth tests it
constexpr double kCloseOverlap = 0.6;    // IoU of three boxes that need no fourth
constexpr std::size_t kMostSeen = 12;    // detections that threes are drawn from, best scores first
constexpr std::size_t kMostAnswers = 8;  // different poses that are refined, best first
constexpr double kKeptOverlap = 0.95;    // share that a refinement must leave
constexpr double kEvident = 12;          // pixels: narrower things are often not detected

struct Hypothesis {
  SE3 T_cw;
  std::vector<int> thing;  // a detection: index into the known ones, or -1
  int agreeing = 0;
  double overlap = 0;   // sum of IoU
  double least = 1;     // of them
  double distance = 0;  // mean of the things that agree
  bool holds = false;
};

// Three detections, and in how many ways they could be known things.
struct Triple {
  Three seen;
  double ways = 0, score = 0;
};

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double cost = 0;
};

class ObjectSearch {
 public:
  ObjectSearch(std::span<const SeenObject> seen, std::span<const KnownObject> known,
               const View& view, const ObjectRelocalizationOptions& options)
      : seen_(seen),
        known_(known),
        pinhole_(view.pinhole()),
        picture_{view.min_x(), view.min_y(), view.max_x(), view.max_y()},
        options_(options),
        may_be_(seen.size()) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i].box.valid()) continue;
      for (std::size_t k = 0; k < known.size(); ++k) {
        if (may_be_one_class(seen[i].class_name, known[k].class_name)) {
          may_be_[i].push_back(static_cast<int>(k));
        }
      }
    }
  }

  void search() {
    int left = options_.max_triples;
    for (const Triple& triple : triples()) {
      const auto& [i, j, k] = triple.seen;
      for (const int a : may_be_[i]) {
        for (const int b : may_be_[j]) {
          for (const int c : may_be_[k]) {
            if (a == b || a == c || b == c) continue;
            if (left-- <= 0) return;
            try_triple(triple.seen, {a, b, c});
          }
        }
      }
    }
  }

  std::optional<ObjectRelocalization> answer() {
    const auto more = [](const Hypothesis& a, const Hypothesis& b) {
      return a.overlap > b.overlap;
    };
    std::stable_sort(answers_.begin(), answers_.end(), more);
    if (answers_.size() > kMostAnswers) answers_.resize(kMostAnswers);
    for (Hypothesis& h : answers_) h = refined(h);
    std::stable_sort(answers_.begin(), answers_.end(), more);
    if (answers_.empty()) return std::nullopt;
    const Hypothesis& best = answers_.front();
    for (const Hypothesis& other : answers_) {
      if (other.overlap >= options_.rival * best.overlap && !one_place(best, other)) {
        return std::nullopt;
      }
    }
    return ObjectRelocalization{best.T_cw, best.thing, best.agreeing, best.overlap, certain(best)};
  }

 private:
  // The most telling first: those that can be the fewest things, then those of the best scores.
  std::vector<Triple> triples() const {
    std::vector<int> usable;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!may_be_[i].empty() && !seen_[i].is_cut()) usable.push_back(static_cast<int>(i));
    }
    std::stable_sort(usable.begin(), usable.end(),
                     [&](int a, int b) { return seen_[a].score > seen_[b].score; });
    if (usable.size() > kMostSeen) usable.resize(kMostSeen);
    std::vector<Triple> result;
    for (std::size_t a = 0; a < usable.size(); ++a) {
      for (std::size_t b = a + 1; b < usable.size(); ++b) {
        for (std::size_t c = b + 1; c < usable.size(); ++c) {
          Triple triple{{usable[a], usable[b], usable[c]}, 1, 1};
          for (const int i : triple.seen) {
            triple.ways *= static_cast<double>(may_be_[i].size());
            triple.score *= seen_[i].score;
          }
          result.push_back(triple);
        }
      }
    }
    std::stable_sort(result.begin(), result.end(), [](const Triple& a, const Triple& b) {
      return std::tuple(a.ways, -a.score) < std::tuple(b.ways, -b.score);
    });
    return result;
  }

  Ellipsoid in_camera(const SE3& T_cw, int thing) const {
    const Ellipsoid& e = known_[thing].ellipsoid;
    return {T_cw * e.T, e.semi_axes};
  }

  void try_triple(const Three& seen, const Three& things) {
    std::array<Vector3d, 3> rays, centres;
    for (int i = 0; i < 3; ++i) {
      rays[i] = pinhole_.unproject(seen_[seen[i]].box.centre());
      centres[i] = known_[things[i]].ellipsoid.centre();
    }
    const PoseCandidates rough = p3p(rays, centres);
    for (int i = 0; i < rough.count; ++i) {
      const std::optional<SE3> T_cw = corrected(rough.poses[i], seen, things);
      if (!T_cw) continue;
      Hypothesis hypothesis = verified(*T_cw);
      if (hypothesis.holds) keep(std::move(hypothesis));
    }
  }

  // The middle of a box is not quite where the centre of the thing shows; by how much, a pose near
  // the true one tells. None where not even the three boxes have the right size.
  std::optional<SE3> corrected(const SE3& T_cw, const Three& seen, const Three& things) const {
    std::array<Vector3d, 3> rays, centres;
    for (int i = 0; i < 3; ++i) {
      const Ellipsoid ellipsoid = in_camera(T_cw, things[i]);
      const std::optional<Box2> box = projected_box(pinhole_, ellipsoid);
      const Box2& observed = seen_[seen[i]].box;
      if (!box || intersection_over_union(*box, observed) < 0.5 * options_.min_overlap) {
        return std::nullopt;
      }
      const Vector2d offset = box->centre() - pinhole_.project(ellipsoid.centre());
      rays[i] = pinhole_.unproject(observed.centre() - offset);
      centres[i] = known_[things[i]].ellipsoid.centre();
    }
    const PoseCandidates candidates = p3p(rays, centres);
    const Vector3d before = T_cw.inverse().translation();
    std::optional<SE3> nearest;
    double least = 0;
    for (int i = 0; i < candidates.count; ++i) {
      const double moved = (candidates.poses[i].inverse().translation() - before).norm();
      if (nearest && !(moved < least)) continue;
      nearest = candidates.poses[i];
      least = moved;
    }
    return nearest ? nearest : T_cw;
  }

  // Which detections are where things of their class should be? One thing each, the best first.
  Hypothesis verified(const SE3& T_cw) const {
    Hypothesis h{T_cw, std::vector<int>(seen_.size(), -1)};
    std::vector<std::tuple<double, int, int>> pairs;  // -IoU, detection, thing
    std::vector<char> evident(known_.size(), 0), taken(known_.size(), 0);
    std::vector<std::optional<Box2>> boxes(known_.size());
    for (std::size_t k = 0; k < known_.size(); ++k) {
      const auto box = projected_box(pinhole_, in_camera(T_cw, static_cast<int>(k)));
      if (!box || !box->clipped(picture_).valid()) continue;
      boxes[k] = box->clipped(picture_);
      evident[k] =
          boxes[k]->edges() == box->edges() && std::min(box->width(), box->height()) >= kEvident;
    }
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      for (const int k : may_be_[i]) {
        if (!boxes[k]) continue;
        const double overlap = intersection_over_union(*boxes[k], seen_[i].box);
        if (overlap >= options_.min_overlap) pairs.emplace_back(-overlap, static_cast<int>(i), k);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    int found = 0;
    for (const auto& [negative, i, k] : pairs) {
      if (h.thing[i] >= 0 || taken[k]) continue;
      h.thing[i] = k;
      taken[k] = 1;
      ++h.agreeing;
      h.overlap -= negative;
      h.least = std::min(h.least, -negative);
      h.distance += (T_cw * known_[k].ellipsoid.centre()).norm();
      found += evident[k];
    }
    h.distance /= std::max(h.agreeing, 1);
    const auto expected = std::count(evident.begin(), evident.end(), 1);
    h.holds = h.agreeing >= kLeastAgreeing && 2 * found > expected;
    return h;
  }

  bool one_place(const Hypothesis& a, const Hypothesis& b) const {
    const double moved = (a.T_cw.inverse().translation() - b.T_cw.inverse().translation()).norm();
    const double turned = a.T_cw.rotation().angularDistance(b.T_cw.rotation()) * 180 / M_PI;
    return turned <= options_.different_deg && moved <= options_.different_share * a.distance;
  }

  void keep(Hypothesis&& hypothesis) {
    for (Hypothesis& known : answers_) {
      if (!one_place(known, hypothesis)) continue;
      if (hypothesis.overlap > known.overlap) known = std::move(hypothesis);
      return;
    }
    answers_.push_back(std::move(hypothesis));
  }

  // What agrees with the refined pose may be more than what it was refined on: so twice. The start
  // was the best of many by overlap alone, which the best pose need not reach quite.
  Hypothesis refined(Hypothesis best) const {
    for (int round = 0; round < 2; ++round) {
      Hypothesis next = verified(fitted(best));
      if (!next.holds || next.agreeing < best.agreeing ||
          next.overlap < kKeptOverlap * best.overlap) {
        break;
      }
      best = std::move(next);
    }
    return best;
  }

  // The edges of the boxes that agree, in σ; those that the border cuts say nothing. The update is
  // T_wc · exp(ξ), which moves an ellipsoid in the camera by exp(−ξ) from the left.
  NormalEquations linearize(const SE3& T_cw, const std::vector<int>& thing) const {
    NormalEquations sum;
    const double loss2 = options_.loss * options_.loss;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (thing[i] < 0) continue;
      const SeenObject& seen = seen_[i];
      const Ellipsoid ellipsoid = in_camera(T_cw, thing[i]);
      BoxByEllipsoid by_ellipsoid;
      const auto box = projected_box(pinhole_, ellipsoid, &by_ellipsoid);
      if (!box) {
        sum.cost = INFINITY;  // no step may push a thing behind the camera
        continue;
      }
      Vector4d r = (box->edges() - seen.box.edges()) / seen.sigma;
      Eigen::Matrix<double, 4, 6> J =
          by_ellipsoid.leftCols<6>() * -adjoint(ellipsoid.T.inverse()) / seen.sigma;
      for (int edge = 0; edge < 4; ++edge) {
        if (!seen.cut[edge]) continue;
        r[edge] = 0;
        J.row(edge).setZero();
      }
      const double share = r.squaredNorm() / loss2, weight = seen.score / (1 + share);
      sum.cost += 0.5 * seen.score * loss2 * std::log1p(share);
      sum.H.noalias() += weight * J.transpose() * J;
      sum.g.noalias() += weight * J.transpose() * r;
    }
    return sum;
  }

  SE3 fitted(const Hypothesis& start) const {
    SE3 best = start.T_cw;
    double damping = 1e-3;
    NormalEquations sum = linearize(best, start.thing);
    for (int step = 0; step < options_.max_steps && std::isfinite(sum.cost); ++step) {
      Matrix6d H = sum.H;
      H.diagonal() *= 1 + damping;
      const Vector6d xi = H.ldlt().solve(-sum.g);
      if (!xi.allFinite()) break;
      const SE3 next = SE3::exp(-xi) * best;
      const NormalEquations there = linearize(next, start.thing);
      if (!(there.cost < sum.cost)) {
        damping *= 10;
        if (damping > 1e6) break;
        continue;
      }
      const bool converged = sum.cost - there.cost < 1e-6 * sum.cost;
      best = next;
      sum = there;
      if (converged) break;
      damping = std::max(0.1 * damping, 1e-9);
    }
    return best;
  }

  bool certain(const Hypothesis& h) const {
    if (h.agreeing >= kSurelyAgreeing) return true;
    if (h.least < kCloseOverlap) return false;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (h.thing[i] >= 0 && may_be_[i].size() != 1) return false;
    }
    return true;
  }

  std::span<const SeenObject> seen_;
  std::span<const KnownObject> known_;
  Pinhole pinhole_;
  Box2 picture_;
  ObjectRelocalizationOptions options_;
  std::vector<std::vector<int>> may_be_;  // a detection: the known things of its class
  std::vector<Hypothesis> answers_;       // different poses, each the best of its place
};

}  // namespace

std::optional<ObjectRelocalization> relocalize_by_objects(
    std::span<const SeenObject> seen, std::span<const KnownObject> known, const View& view,
    const ObjectRelocalizationOptions& options) {
  ObjectSearch search(seen, known, view, options);
  search.search();
  return search.answer();
}

}  // namespace cairn
