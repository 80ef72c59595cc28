#include "cairn/features/subpixel.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr float kFarthest = 0.75F;

float parabola_peak(float before, float at, float after) {
  const float curvature = before - 2 * at + after;
  if (curvature >= 0) return 0;
  return std::clamp((before - after) / (2 * curvature), -0.5F, 0.5F);
}

}  // namespace

cv::Point2f peak_offset(const std::array<std::uint8_t, 9>& response) {
  const auto r = [&](int column, int row) {
    return static_cast<float>(response[row * 3 + column]);
  };
  // Least squares over the nine responses; all sums are small integers, thus exact.
  float dx = 0, dy = 0, dxx = 0, dyy = 0;
  for (int i = 0; i < 3; ++i) {
    dx += r(2, i) - r(0, i);
    dy += r(i, 2) - r(i, 0);
    dxx += r(2, i) - 2 * r(1, i) + r(0, i);
    dyy += r(i, 2) - 2 * r(i, 1) + r(i, 0);
  }
  // In units of one sixth of a grey level.
  dxx *= 2;
  dyy *= 2;
  const float dxy = (r(2, 2) + r(0, 0) - r(0, 2) - r(2, 0)) * 6 / 4;
  const float determinant = dxx * dyy - dxy * dxy;
  if (dxx < 0 && determinant > 0) {
    const float x = (dxy * dy - dyy * dx) / determinant;
    const float y = (dxy * dx - dxx * dy) / determinant;
    if (std::abs(x) <= kFarthest && std::abs(y) <= kFarthest) return {x, y};
  }
  return {parabola_peak(r(0, 1), r(1, 1), r(2, 1)), parabola_peak(r(1, 0), r(1, 1), r(1, 2))};
}

}  // namespace cairn
