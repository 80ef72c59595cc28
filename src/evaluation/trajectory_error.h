#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cairn/evaluation/association.h"
#include "cairn/geometry/trajectory.h"

namespace cairn {

/// Of distances in metres.
struct ErrorStatistics {
  double rmse = 0, median = 0, max = 0, mean = 0;
};
ErrorStatistics statistics(std::vector<double> values);

/// Root mean squares over pairs of poses; nothing if there is no pair of that kind.
struct RelativeError {
  std::size_t pairs = 0;
  std::optional<double> translation;   ///< metres
  std::optional<double> rotation_deg;  ///< degrees
};

/// Distances between positions, metres. Both lists are paired and aligned.
std::vector<double> absolute_errors(std::span<const StampedPose> truth,
                                    std::span<const StampedPose> estimate);

/// The error of relative motion, `(T_true,i⁻¹ T_true,j)⁻¹ (T_est,i⁻¹ T_est,j)`, over index pairs
/// (Sturm et al., IROS 2012).
RelativeError relative_error(std::span<const StampedPose> truth,
                             std::span<const StampedPose> estimate,
                             std::span<const IndexPair> pairs);

/// (0,1), (1,2), ...: as `evo_rpe --delta 1 --delta_unit f`.
std::vector<IndexPair> pairs_by_frame(std::size_t count);

/// Poses `seconds` apart: for each pose the one nearest to that much later, if it is within a tenth
/// of it. Gaps give no pairs. (evo has no such unit; this is the TUM benchmark's way.)
std::vector<IndexPair> pairs_by_time(std::span<const StampedPose> poses, double seconds);

/// Walks along the path; whenever `metres` have been gone since the last mark, a mark is set; pairs
/// are consecutive marks. As `evo_rpe --delta 1 --delta_unit m`, in that the start is no mark.
std::vector<IndexPair> pairs_by_path(std::span<const StampedPose> poses, double metres);

}  // namespace cairn
