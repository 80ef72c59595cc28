#pragma once

#include <array>
#include <cstdint>

#include "cairn/geometry/box.h"
#include "cairn/geometry/camera.h"
#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// What is wrong with the boxes of a trial, or with its start.
enum class TrialWorld {
  kClean,      ///< 2 px of noise on every edge
  kOutliers,   ///< one box in ten is off by 30 px
  kTruncated,  ///< six cameras look past the thing: their border cuts a fifth to a half of it off
  kDisplaced,  ///< the start is 0.15 m off along every axis, not 0.06 m
};

/// One ellipsoid at the world's origin, z up, 12 cameras on an arc around it, boxes, and a start
/// for a fit: the experiment of docs/objects.md, "An ellipsoid from boxes".
struct EllipsoidTrial {
  static constexpr int kViews = 12;
  static constexpr Pinhole kPinhole{525, 525, 320, 240};
  /// Here coordinates run from 0 to the width and height, not to the last pixel's middle.
  static constexpr Box2 kPicture{0, 0, 640, 480};
  static constexpr double kUsualAxis = 0.12;  ///< metres; of the draws their median

  struct View {
    SE3 T_cw;
    Box2 box;  ///< clipped to the picture
    /// Left, top, right, bottom: within 3 px of the picture's border.
    std::array<bool, 4> cut{};
    double score = 1;
  };

  Ellipsoid truth, start;
  std::array<View, kViews> views;
};

/// The trial of a seed: the same draws for every span (degrees, of the arc) and every world.
EllipsoidTrial make_ellipsoid_trial(std::uint64_t seed, double span_deg, TrialWorld world);

}  // namespace cairn
