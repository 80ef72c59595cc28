#pragma once

#include <cstddef>
#include <cstdint>

#include "cairn/features/features.h"

namespace cairn {

/// The direction of a keypoint as a unit vector. Its parts are multiples of 2^-14, so that turning
/// the pattern by it is exact in single precision, with or without fused multiply-add: descriptors
/// are the same on every machine.
struct Orientation {
  float cos = 1, sin = 0;
};

/// No pixel farther than this from the keypoint, along x or y, is read by the functions below.
inline constexpr int kOrbPatchMargin = 19;

/// Orientation by the intensity centroid of the disc of radius 15 (Rublee et al. 2011,
/// section 3.2). `center` points at the keypoint's pixel; `step`: bytes a row.
Orientation intensity_centroid(const std::uint8_t* center, std::ptrdiff_t step);

/// Of an angle in radians, x towards y.
Orientation orientation_of(float angle);

/// Radians in (-pi, pi], x towards y.
float angle_of(const Orientation& orientation);

/// Rotated BRIEF (Rublee et al. 2011, section 4) of a keypoint in a blurred picture. Bit i is set
/// if the first pixel of test i is darker than the second; the bits are in cv::ORB's order.
Descriptor describe(const std::uint8_t* blurred_center, std::ptrdiff_t step,
                    const Orientation& orientation);

}  // namespace cairn
