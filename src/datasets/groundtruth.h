#pragma once

#include <filesystem>
#include <string>

#include "cairn/geometry/trajectory.h"

namespace cairn {

/// Reads poses of the camera (camera to world, seconds, metres). `layout`:
/// - "tum": `timestamp tx ty tz qx qy qz qw`, also what cairn writes itself;
/// - "kitti": rows of 3x4 matrices; times from `times.txt` beside the file or in
///   `../sequences/<name>/`;
/// - "euroc": csv in nanoseconds, body poses, taken to the camera with the T_BS of
///   `../cam0/sensor.yaml`;
/// - "auto": by the ending (.csv) and the number of columns.
/// Rows are sorted by time; of repeated times the first row is kept. Throws Error(kInput), with the
/// line number, if a row is malformed or not finite, or if there is none.
Trajectory read_groundtruth(const std::filesystem::path& file, const std::string& layout = "auto");

}  // namespace cairn
