#pragma once

#include <string>
#include <vector>

namespace cairn::app {

/// Sets of landmarks side by side: points, pp, ppm, po, full. Each seed is another run of a
/// sequence, or, without `data`, another synthetic desk, room and corridor with simulated
/// perception. `groundtruth`: in place of that of the (only) sequence, if not empty. `planes`:
/// where planes of the sequences come from, network, rgbd or recorded; empty: recorded where there
/// is a recording. Objects come from the recording, else from the network, if it is found; without
/// either the sets with objects are left out.
/// Prints a table, or one JSON object; returns the exit code.
int bench_landmarks(const std::vector<std::string>& data, const std::string& groundtruth,
                    const std::string& planes, int seeds, bool json);

}  // namespace cairn::app
