#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cairn/evaluation/alignment.h"
#include "cairn/evaluation/trajectory_error.h"
#include "cairn/geometry/trajectory.h"

namespace cairn {

struct EvaluationOptions {
  Alignment alignment = Alignment::kSim3;
  double max_difference = 0.01;  ///< seconds between a pose and its ground truth
  double offset = 0;             ///< seconds, added to the times of the estimate
};

/// How far an estimate is from the truth. Figures agree with evo's `evo_ape tum -as` and
/// `evo_rpe tum -as`; over one second see pairs_by_time.
struct EvaluationReport {
  EvaluationOptions options;
  std::size_t pairs = 0;              ///< poses with a ground truth
  std::size_t frames_with_truth = 0;  ///< denominator of the coverage
  double coverage = 0;                ///< frames with a pose / frames with ground truth
  double scale = 1;                   ///< of the alignment; 1 unless sim3
  /// |s − 1| with s the scale of the sim3 alignment, whichever was chosen; nothing where that is
  /// not determined.
  std::optional<double> scale_error;
  std::optional<double> scale_sigma;  ///< relative, as the run itself says; evaluate() sets none
  ErrorStatistics ate;                ///< metres
  RelativeError frame, second, metre;
  TrajectoryAlignment alignment;
  TrajectoryAlignment landmark_alignment;  ///< for objects and planes: see align_views
  Trajectory truth;                        ///< paired poses
  Trajectory estimate;                     ///< the same, aligned, at the times of the truth
  std::vector<double> errors;              ///< their distances, metres
};

/// Throws Error(kInput), with the reason, if the two cannot be compared. `frame_times`: the times
/// of all pictures, in seconds, for the coverage. Without them, the number of frames with ground
/// truth is guessed: one a ground-truth pose, or, where the ground truth is denser than the
/// estimate, one a median step of the estimate over the span of the ground truth.
EvaluationReport evaluate(const Trajectory& truth, const Trajectory& estimate,
                          const EvaluationOptions& options = {},
                          std::span<const double> frame_times = {});

/// Those of the poses whose frames `others` have, too: where two runs do not hold the same frames,
/// only on these can they be compared. Times are on one clock, `max_difference` in seconds.
Trajectory common_poses(const Trajectory& poses, const Trajectory& others,
                        double max_difference = 0.001);

/// "sim3", "se3", "none"; anything else throws Error(kUsage).
Alignment parse_alignment(const std::string& name);
std::string to_string(Alignment alignment);

/// The keys of the contract: pairs, coverage, scale, scale_error, scale_sigma, ate.{rmse, median,
/// max, mean}, rpe.{frame, second, metre}.{translation, rotation_deg, pairs}. Null where there is
/// no figure.
nlohmann::json to_json(const EvaluationReport& report);

/// A table for people.
std::string to_table(const EvaluationReport& report);

}  // namespace cairn
