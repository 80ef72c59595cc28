#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace cairn {

enum class QuickSurface { kWood, kTiles, kWallpaper, kPrint };

/// A picture to put on a surface, CV_8UC3, with detail at all scales, of which every patch looks
/// different from every other. Depends on its arguments alone.
cv::Mat make_quick_texture(QuickSurface surface, const cv::Size& size, std::uint64_t seed);

}  // namespace cairn
