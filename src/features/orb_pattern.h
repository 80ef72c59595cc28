#pragma once

#include <array>
#include <cstdint>

namespace cairn {

/// The 256 binary tests of ORB in a patch of 31x31 pixels (Rublee et al. 2011, section 4.3), learnt
/// for high variance and low correlation: test i compares the pixels (x0, y0) and (x1, y1),
/// relative to the keypoint, before rotation. Four numbers a test. They are those of cv::ORB, so
/// that descriptors can be compared with those of other programs.
extern const std::array<std::int8_t, 256 * 4> kOrbPattern;

/// No pixel of the pattern is farther from the keypoint, in whole pixels, at any rotation.
inline constexpr int kOrbPatternRadius = 18;

}  // namespace cairn
