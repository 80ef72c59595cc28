#pragma once

#include <string>

#include "cairn/evaluation/evaluation.h"
#include "cairn/evaluation/measured_planes.h"

namespace cairn::app {

/// The planes of a run, in the world of `truth`, against the measured depth of the sequence that it
/// was made from. `truth`: poses of the colour camera. Throws Error.
MeasuredPlaneReport evaluate_depth(const std::string& sequence, std::vector<FoundPlane> planes,
                                   const Trajectory& truth, const EvaluationOptions& options);

}  // namespace cairn::app
