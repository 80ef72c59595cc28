#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace cairn {

/// No pixel farther than this from the corner, along x or y, is read by refine_corner().
inline constexpr int kSubpixelMargin = 5;

/// Offset in pixels from the pixel at `center` to the corner, at most one along x and y: the point
/// that lies closest to the tangents of all edges in a 7x7 window (Foerstner and Gülch 1987). Zero
/// where edges do not determine it. `step`: bytes a row.
cv::Point2f refine_corner(const std::uint8_t* center, std::ptrdiff_t step);

}  // namespace cairn
