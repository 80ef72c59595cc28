#pragma once

#include <string>
#include <vector>

namespace cairn::app {

/// Sets of landmarks side by side: points, pp, ppm. Each seed is another run of a sequence, or,
/// without `data`, another synthetic desk, room and corridor with simulated perception.
/// `groundtruth`: in place of that of the (only) sequence, if not empty. Prints a table, or one
/// JSON object; returns the exit code.
int bench_landmarks(const std::vector<std::string>& data, const std::string& groundtruth, int seeds,
                    bool json);

}  // namespace cairn::app
