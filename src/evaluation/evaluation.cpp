#include "cairn/evaluation/evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

std::vector<double> times_of(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) times.push_back(pose.timestamp);
  return times;
}

std::string span_of(const std::vector<double>& times) {
  char text[96];
  std::snprintf(text, sizeof text, "%.3f s to %.3f s", times.front(), times.back());
  return text;
}

double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  return steps.empty() ? 0 : statistics(steps).median;
}

std::vector<IndexPair> checked_pairs(const std::vector<double>& truth,
                                     const std::vector<double>& estimate,
                                     const EvaluationOptions& options) {
  const auto refuse = [](const std::string& why) {
    throw Error(Error::Kind::kInput, "evaluation: " + why);
  };
  if (truth.empty()) refuse("the ground truth holds no poses; name another file");
  if (estimate.empty()) refuse("the estimate holds no poses; nothing was tracked");
  auto pairs = associate(truth, estimate, options.max_difference, options.offset);
  if (pairs.empty()) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g", options.max_difference);
    refuse("no pose of the estimate (" + span_of(estimate) + ") has a ground truth (" +
           span_of(truth) + ") within " + limit +
           " s; check that both are of the same sequence, or use --offset and --max-difference");
  }
  return pairs;
}

void set_coverage(const std::vector<double>& truth, const std::vector<double>& estimate,
                  std::span<const double> frame_times, EvaluationReport& report) {
  const double limit = report.options.max_difference, offset = report.options.offset;
  if (!frame_times.empty()) {
    std::vector<double> frames(frame_times.begin(), frame_times.end());
    std::sort(frames.begin(), frames.end());
    // Frames are on the clock of the estimate. Those with a truth, then those of them with a pose.
    std::vector<double> with_truth;
    for (const IndexPair& pair : associate(truth, frames, limit, offset)) {
      with_truth.push_back(frames[pair.second]);
    }
    report.frames_with_truth = with_truth.size();
    report.coverage = with_truth.empty() ? 0
                                         : double(associate(with_truth, estimate, limit).size()) /
                                               double(with_truth.size());
    return;
  }
  double expected = double(truth.size());
  if (const double step = median_step(estimate); step > 0) {
    expected = std::min(expected, std::round((truth.back() - truth.front()) / step) + 1);
  }
  report.frames_with_truth = std::max(std::size_t(expected), report.pairs);
  report.coverage = double(report.pairs) / double(report.frames_with_truth);
}

}  // namespace

Alignment parse_alignment(const std::string& name) {
  if (name == "sim3") return Alignment::kSim3;
  if (name == "se3") return Alignment::kSE3;
  if (name == "none") return Alignment::kNone;
  throw Error(Error::Kind::kUsage,
              "--align " + name + ": there is no such alignment; use sim3, se3 or none");
}

std::string to_string(Alignment alignment) {
  switch (alignment) {
    case Alignment::kSim3:
      return "sim3";
    case Alignment::kSE3:
      return "se3";
    case Alignment::kNone:
      break;
  }
  return "none";
}

Trajectory common_poses(const Trajectory& poses, const Trajectory& others, double max_difference) {
  Trajectory common;
  for (const auto& [i, j] : associate(times_of(poses), times_of(others), max_difference)) {
    common.push_back(poses[i]);
  }
  return common;
}

EvaluationReport evaluate(const Trajectory& truth, const Trajectory& estimate,
                          const EvaluationOptions& options, std::span<const double> frame_times) {
  const auto truth_times = times_of(truth), estimate_times = times_of(estimate);
  const auto pairs = checked_pairs(truth_times, estimate_times, options);
  EvaluationReport report;
  report.options = options;
  report.pairs = pairs.size();
  std::vector<Vector3d> from, to;
  std::vector<SE3> seen_from, seen_to;
  for (const auto& [i, j] : pairs) {
    report.truth.push_back(truth[i]);
    to.push_back(truth[i].T_wc.translation());
    from.push_back(estimate[j].T_wc.translation());
    seen_to.push_back(truth[i].T_wc);
    seen_from.push_back(estimate[j].T_wc);
  }
  report.alignment = align_trajectory(from, to, options.alignment);
  report.scale = report.alignment.scale;
  try {
    report.scale_error = std::abs(align_trajectory(from, to, Alignment::kSim3).scale - 1);
  } catch (const Error&) {
    report.scale_error.reset();  // only possible where no alignment was asked for
  }
  report.landmark_alignment = report.alignment;
  if (options.alignment != Alignment::kNone) {
    report.landmark_alignment = align_views(report.alignment, seen_from, seen_to);
  }
  for (const auto& [i, j] : pairs) {
    report.estimate.push_back({truth[i].timestamp, report.alignment * estimate[j].T_wc});
  }
  report.errors = absolute_errors(report.truth, report.estimate);
  report.ate = statistics(report.errors);
  report.frame =
      relative_error(report.truth, report.estimate, pairs_by_frame(report.estimate.size()));
  report.second = relative_error(report.truth, report.estimate, pairs_by_time(report.estimate, 1));
  report.metre = relative_error(report.truth, report.estimate, pairs_by_path(report.estimate, 1));
  set_coverage(truth_times, estimate_times, frame_times, report);
  return report;
}

}  // namespace cairn
