#pragma once

#include <filesystem>

#include "cairn/geometry/trajectory.h"

namespace cairn {

/// TUM format: `timestamp tx ty tz qx qy qz qw`, camera to world, seconds, qw not negative. Numbers
/// read back exactly. Throws Error(kOutput).
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace cairn
