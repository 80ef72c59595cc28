#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace cairn {

/// Offset in pixels, at most 0.75 along x and y, from the middle one of 3x3 corner responses (row
/// by row) to the peak of the quadric that fits them best; where that has no peak near, of the two
/// parabolas through the middle.
///
/// Meant for FAST's own response. On pairs of real pictures (7-Scenes, TUM) it brings the median
/// distance of matched keypoints to their epipolar lines from 0.42 to 0.27 px and from 0.47 to
/// 0.33 px. Harris' response on a smoothed picture, searched for its peak, comes to the same median
/// with fewer matches within half a pixel, at several times the cost, though on drawn corners it is
/// the finer one.
cv::Point2f peak_offset(const std::array<std::uint8_t, 9>& response);

}  // namespace cairn
