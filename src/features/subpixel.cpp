#include "cairn/features/subpixel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cairn/features/multiversion.h"

namespace cairn {
namespace {

constexpr int kRadius = 3;
constexpr int kSide = 8;  // one more than the window has, without weight: a whole register

/// Integer sums over the window of weighted products of gradients, and of those with x and y.
struct GradientMoments {
  std::int32_t xx = 0, xy = 0, yy = 0, x = 0, y = 0;
};

struct Window {
  alignas(32) std::array<std::array<std::int16_t, kSide>, 2 * kRadius + 1> weight = {};

  Window() {
    for (int v = -kRadius; v <= kRadius; ++v) {
      for (int u = -kRadius; u <= kRadius; ++u) {
        weight[v + kRadius][u + kRadius] =
            static_cast<std::int16_t>(std::lround(16 * std::exp(-(u * u + v * v) / 8.0)));
      }
    }
  }
};

CAIRN_MULTIVERSION
GradientMoments gradient_moments(const std::uint8_t* center, std::ptrdiff_t step,
                                 const Window& window) {
  GradientMoments sum;
  for (int v = -kRadius; v <= kRadius; ++v) {
    const std::uint8_t* const row = center + v * step - kRadius;
    for (int i = 0; i < kSide; ++i) {
      const std::int32_t gx = row[i + 1] - row[i - 1];
      const std::int32_t gy = row[i + step] - row[i - step];
      const std::int32_t weight = window.weight[v + kRadius][i];
      const std::int32_t xx = weight * gx * gx, xy = weight * gx * gy, yy = weight * gy * gy;
      sum.xx += xx;
      sum.xy += xy;
      sum.yy += yy;
      sum.x += xx * (i - kRadius) + xy * v;
      sum.y += xy * (i - kRadius) + yy * v;
    }
  }
  return sum;
}

}  // namespace

cv::Point2f refine_corner(const std::uint8_t* center, std::ptrdiff_t step) {
  static const Window window;
  const GradientMoments sum = gradient_moments(center, step, window);
  const double xx = sum.xx, xy = sum.xy, yy = sum.yy;
  const double determinant = xx * yy - xy * xy, trace = xx + yy;
  // A ratio of eigenvalues of about 30: beyond, the corner may slide along an edge.
  if (determinant * 32 < trace * trace) return {0, 0};
  const double x = (yy * sum.x - xy * sum.y) / determinant;
  const double y = (xx * sum.y - xy * sum.x) / determinant;
  if (std::abs(x) > 1 || std::abs(y) > 1) return {0, 0};
  return {static_cast<float>(x), static_cast<float>(y)};
}

}  // namespace cairn
