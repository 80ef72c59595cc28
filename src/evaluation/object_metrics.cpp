#include "cairn/evaluation/object_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cairn/evaluation/pairing.h"
#include "cairn/evaluation/trajectory_error.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNoPair = 3;  // more than any pair that can be the same costs

// The 24 rotations that take the axes to the axes.
std::vector<Matrix3d> axis_renamings() {
  std::vector<Matrix3d> renamings;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d P = Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) P(order[i], i) = (signs >> i) & 1 ? -1 : 1;
      if (P.determinant() > 0) renamings.push_back(P);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return renamings;
}

double angle_of(const Matrix3d& R) { return so3_log(Eigen::Quaterniond(R)).norm(); }

// The least angle of `turn` after a turn about `axis` that leaves the thing as it is.
double angle_up_to(TurnSymmetry symmetry, const Vector3d& axis, const Matrix3d& turn) {
  int steps = 1;
  switch (symmetry) {
    case TurnSymmetry::kAnyTurn:
      return std::atan2(axis.cross(turn * axis).norm(), axis.dot(turn * axis));
    case TurnSymmetry::kHalfTurn:
      steps = 2;
      break;
    case TurnSymmetry::kQuarterTurn:
      steps = 4;
      break;
    case TurnSymmetry::kNone:
      break;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < steps; ++i) {
    const Eigen::AngleAxisd own(2 * M_PI * i / steps, axis);
    least = std::min(least, angle_of(turn * own.toRotationMatrix()));
  }
  return least;
}

// What a pair costs, below kNoPair, if the two can be the same object.
double pair_cost(const TrueObject& truth, const FoundObject& found,
                 const ObjectMetricsOptions& options) {
  const double limit = std::max(options.max_centre_distance, truth.ellipsoid.semi_axes.maxCoeff());
  const double distance = (truth.ellipsoid.centre() - found.ellipsoid.centre()).norm();
  if (!(distance < limit)) return kNoPair;
  const double iou = intersection_over_union(truth.ellipsoid, found.ellipsoid);
  const bool differ = truth.class_name != found.class_name;
  if (differ && iou < options.min_iou_across_classes) return kNoPair;
  return (1 - iou) + distance / limit + (differ ? 1 : 0);
}

ObjectMatch describe(std::size_t i, const TrueObject& truth, std::size_t j,
                     const FoundObject& found) {
  const ShapeDifference shape = compare_shapes(truth, found.ellipsoid);
  std::optional<double> outline_iou;
  if (truth.outlines) outline_iou = intersection_over_union(*truth.outlines, found.ellipsoid);
  return {.truth = i,
          .found = j,
          .wrong_class = truth.class_name != found.class_name,
          .centre_error = (truth.ellipsoid.centre() - found.ellipsoid.centre()).norm(),
          .iou = intersection_over_union(truth.ellipsoid, found.ellipsoid),
          .outline_iou = outline_iou,
          .axis_error = shape.axis_error,
          .rotation = shape.rotation};
}

void set_medians(std::span<const ObjectMatch> scored, ObjectMetrics& metrics) {
  if (scored.empty()) return;
  const auto median = [&](double ObjectMatch::*member) {
    std::vector<double> values;
    for (const ObjectMatch& match : scored) values.push_back(match.*member);
    return statistics(values).median;
  };
  metrics.centre_error = median(&ObjectMatch::centre_error);
  metrics.iou = median(&ObjectMatch::iou);
  std::vector<double> outline_ious;
  for (const ObjectMatch& match : scored) {
    if (match.outline_iou) outline_ious.push_back(*match.outline_iou);
  }
  if (!outline_ious.empty()) metrics.outline_iou = statistics(outline_ious).median;
  metrics.axis_error = median(&ObjectMatch::axis_error);
  metrics.rotation_deg = median(&ObjectMatch::rotation) * 180 / M_PI;
}

}  // namespace

ShapeDifference compare_shapes(const TrueObject& truth, const Ellipsoid& found) {
  static const std::vector<Matrix3d> kRenamings = axis_renamings();
  const Vector3d& axes = truth.ellipsoid.semi_axes;
  ShapeDifference best;
  double least = std::numeric_limits<double>::infinity();
  for (const Matrix3d& P : kRenamings) {
    // The columns of R are the found axes in the order of the true ones.
    const Matrix3d R = found.T.matrix3() * P;
    const Vector3d renamed = P.cwiseAbs().transpose() * found.semi_axes;
    const Matrix3d turn = R * truth.ellipsoid.T.matrix3().transpose();
    const ShapeDifference difference = {
        .axis_error = (renamed - axes).cwiseAbs().cwiseQuotient(axes).mean(),
        .rotation = angle_up_to(truth.symmetry, truth.axis, turn)};
    if (difference.axis_error + difference.rotation < least) {
      least = difference.axis_error + difference.rotation;
      best = difference;
    }
  }
  return best;
}

ObjectMetrics object_metrics(std::span<const TrueObject> truth, std::span<const FoundObject> found,
                             const ObjectMetricsOptions& options) {
  Eigen::MatrixXd cost(truth.size(), found.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      cost(i, j) = pair_cost(truth[i], found[j], options);
    }
  }
  const Pairing pairing = pair_landmarks(cost, kNoPair);
  ObjectMetrics metrics;
  metrics.duplicated = pairing.rivals.size();
  metrics.false_objects = pairing.strangers.size();
  std::vector<ObjectMatch> scored;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool counts = truth[i].visible_frames >= options.min_visible_frames &&
                        truth[i].visible_span_deg >= options.min_visible_span_deg;
    const int j = pairing.found_of[i];
    if (j < 0) {
      metrics.missed += counts;
      continue;
    }
    metrics.matches.push_back(describe(i, truth[i], j, found[j]));
    ++(counts ? metrics.found : metrics.ignored);
    if (counts) scored.push_back(metrics.matches.back());
  }
  for (const ObjectMatch& match : scored) metrics.wrong_class += match.wrong_class;
  set_medians(scored, metrics);
  return metrics;
}

}  // namespace cairn
