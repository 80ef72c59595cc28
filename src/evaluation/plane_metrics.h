#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cairn/evaluation/found_landmarks.h"
#include "cairn/evaluation/world_truth.h"

namespace cairn {

/// When a found plane and a true one agree.
struct PlaneMetricsOptions {
  double max_angle_deg = 10;  ///< between the normals, whichever sides they point to
  double max_offset = 0.1;    ///< metres, from the middle of the found outline to the true plane
  /// Metres. Half of the area in the found outline, projected into the true plane, lies on the true
  /// surface or not farther than this from it. (The middle of an L-shaped floor is not on it.)
  double max_outside = 0.1;
  /// A true plane that is well seen in fewer frames can not be missed. Planes of which world.json
  /// does not say in how many frames they are seen count as always seen.
  int min_visible_frames = 10;
};

struct PlaneMatch {
  std::size_t truth = 0, found = 0;  ///< indices into the two lists
  double angle = 0;   ///< radians, between the normals, whichever sides they point to
  double offset = 0;  ///< metres, from the middle of the found outline to the true plane
};

/// Planes are matched one to one, so a surface that the map holds twice is once right and once
/// wrong. Matches of true planes that are not seen often enough count nowhere.
struct PlaneMetrics {
  std::size_t correct = 0;     ///< true planes (seen often enough) that have a match
  std::size_t missed = 0;      ///< true planes (seen often enough) that have none
  std::size_t duplicated = 0;  ///< found planes that agree with a true one that has a better match
  std::size_t false_planes = 0;             ///< found planes that agree with none
  std::optional<double> precision;          ///< correct / (correct + duplicated + false)
  std::optional<double> recall;             ///< correct / (correct + missed)
  std::optional<double> angle_deg, offset;  ///< medians over the correct ones: degrees, metres
  std::vector<PlaneMatch> matches;          ///< of all true planes, in their order
};

/// `found` is aligned with the truth. The assignment minimises angle and offset, as shares of what
/// is allowed, over pairs that agree; the rest costs 2 a pair.
PlaneMetrics plane_metrics(std::span<const TruePlane> truth, std::span<const FoundPlane> found,
                           const PlaneMetricsOptions& options = {});

}  // namespace cairn
