#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace cairn {

/// How many weights (floats) the layers of a Darknet network (.cfg) read from its file of weights.
/// None where a layer has weights that are not counted here (connected, recurrent). Throws
/// Error(kInput) for a file that is no such network.
std::optional<std::int64_t> darknet_weight_count(const std::filesystem::path& cfg);

/// Throws Error(kInput) if the file of weights is not exactly as long as the network needs. OpenCV
/// reads past the end of a short one without a word, and its layers then hold what was in memory.
void check_darknet_weights(const std::filesystem::path& cfg, const std::filesystem::path& weights);

}  // namespace cairn
