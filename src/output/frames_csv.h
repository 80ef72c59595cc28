#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "cairn/map/frame_record.h"

namespace cairn {

/// A row a frame: timestamp (s), state, matches, inliers, keyframe (0 or 1), extract_ms,
/// predict_ms, local_map_ms, total_ms. Throws Error(kOutput).
void write_frames_csv(const std::filesystem::path& file, std::span<const FrameRecord> frames);

/// The column `timestamp` of such a file, seconds. Throws Error(kInput).
std::vector<double> read_frame_times(const std::filesystem::path& file);

}  // namespace cairn
