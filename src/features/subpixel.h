#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace cairn {

/// Offset in pixels, at most 0.75 along x and y, from the middle one of 3x3 corner responses (row
/// by row) to the peak of the quadric that fits them best; where that has no peak near, of the two
/// parabolas through the middle.
///
/// It is fitted to FAST's own response: on real pictures matched keypoints then lie nearer to their
/// epipolar lines (median 0.27 px instead of 0.42 px on 7-Scenes) than with the peak of Harris' or
/// Shi and Tomasi's response or Foerstner's point, none of which is where FAST finds a corner.
cv::Point2f peak_offset(const std::array<std::uint8_t, 9>& response);

}  // namespace cairn
