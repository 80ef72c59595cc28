#include "evaluate_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/datasets/sequence.h"
#include "playback.h"

namespace cairn::app {
namespace {

constexpr double kPictures = 100;  // taken, at most, evenly spread in time

// Null where none is near.
const StampedPose* nearest_pose(const Trajectory& truth, double time, double max_difference) {
  const auto distance = [&](const StampedPose& pose) { return std::abs(pose.timestamp - time); };
  const auto nearest =
      std::min_element(truth.begin(), truth.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return nearest != truth.end() && distance(*nearest) <= max_difference ? &*nearest : nullptr;
}

}  // namespace

MeasuredPlaneReport evaluate_depth(const std::string& sequence, std::vector<FoundPlane> planes,
                                   const Trajectory& truth, const EvaluationOptions& options) {
  OpenOptions open;
  open.depth = true;
  const Sequence depth = open_sequence(sequence, open);
  const Camera& camera = camera_of(depth, sequence);
  MeasuredPlanes measured(std::move(planes));
  const double step = (truth.back().timestamp - truth.front().timestamp) / kPictures;
  double next = -std::numeric_limits<double>::infinity();
  for (SourceFrame frame; depth.frames->next(frame);) {
    const double time = frame.timestamp + options.offset;
    if (frame.depth.empty() || time < next) continue;
    const StampedPose* pose = nearest_pose(truth, time, options.max_difference);
    if (pose == nullptr) continue;
    measured.add(frame.depth, camera, pose->T_wc);
    next = time + step;
  }
  return measured.report();
}

}  // namespace cairn::app
