#pragma once

namespace cairn::app {

constexpr int kEllipsoidTrials = 200;

/// Fits of one ellipsoid to boxes in a simulator, without SLAM: spans of the cameras' arc, what is
/// wrong with the boxes, and forms of the factor, over the trials 1 to `seeds`
/// (docs/objects.md, "An ellipsoid from boxes"). Prints a table, or one JSON object; returns the
/// exit code.
int bench_ellipsoids(int seeds, bool json);

}  // namespace cairn::app
