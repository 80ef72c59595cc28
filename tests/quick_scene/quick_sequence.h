#pragma once

#include <filesystem>

namespace cairn {

/// Writes the first pictures of QuickScene(0) in TUM layout, 30 a second, with calibration and
/// ground truth.
void write_quick_sequence(const std::filesystem::path& folder, int frames);

}  // namespace cairn
