#include "cairn/evaluation/plane_metrics.h"

#include <algorithm>
#include <cmath>

#include "cairn/evaluation/outline.h"
#include "cairn/evaluation/pairing.h"
#include "cairn/evaluation/trajectory_error.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr double kNoPair = 2;      // more than any pair that agrees costs
constexpr double kMostOfIt = 0.5;  // of what was found, that is where the true one is

// angle and offset of a pair, agreeing or not.
PlaneMatch compare(const TruePlane& truth, const FoundPlane& found) {
  PlaneMatch match;
  match.angle =
      std::atan2(truth.normal.cross(found.normal).norm(), std::abs(truth.normal.dot(found.normal)));
  match.offset = std::abs(truth.normal.dot(middle(found.outline)) + truth.d);
  return match;
}

// Below kNoPair if the two agree.
double pair_cost(const TruePlane& truth, const FoundPlane& found,
                 const PlaneMetricsOptions& options) {
  const PlaneMatch match = compare(truth, found);
  const double angle = match.angle * 180 / M_PI / options.max_angle_deg;
  const double offset = match.offset / options.max_offset;
  if (!(angle < 1 && offset < 1)) return kNoPair;
  const double inside = share_on(truth.parts, truth.normal, found.outline, options.max_outside);
  return inside < kMostOfIt ? kNoPair : angle + offset;
}

void set_summary(std::span<const PlaneMatch> scored, PlaneMetrics& metrics) {
  metrics.correct = scored.size();
  const std::size_t found = metrics.correct + metrics.duplicated + metrics.false_planes;
  const std::size_t there = metrics.correct + metrics.missed;
  if (found > 0) metrics.precision = double(metrics.correct) / double(found);
  if (there > 0) metrics.recall = double(metrics.correct) / double(there);
  if (scored.empty()) return;
  std::vector<double> angles, offsets;
  for (const PlaneMatch& match : scored) {
    angles.push_back(match.angle * 180 / M_PI);
    offsets.push_back(match.offset);
  }
  metrics.angle_deg = statistics(angles).median;
  metrics.offset = statistics(offsets).median;
}

}  // namespace

PlaneMetrics plane_metrics(std::span<const TruePlane> truth, std::span<const FoundPlane> found,
                           const PlaneMetricsOptions& options) {
  Eigen::MatrixXd cost(truth.size(), found.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      cost(i, j) = pair_cost(truth[i], found[j], options);
    }
  }
  const Pairing pairing = pair_landmarks(cost, kNoPair);
  PlaneMetrics metrics;
  metrics.duplicated = pairing.rivals.size();
  metrics.false_planes = pairing.strangers.size();
  std::vector<PlaneMatch> scored;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool counts = truth[i].visible_frames >= options.min_visible_frames;
    const int j = pairing.found_of[i];
    if (j < 0) {
      metrics.missed += counts;
      continue;
    }
    PlaneMatch match = compare(truth[i], found[j]);
    match.truth = i;
    match.found = j;
    metrics.matches.push_back(match);
    if (counts) scored.push_back(match);
  }
  set_summary(scored, metrics);
  return metrics;
}

}  // namespace cairn
