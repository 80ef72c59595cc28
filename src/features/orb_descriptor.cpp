#include "cairn/features/orb_descriptor.h"

#include <array>
#include <bit>
#include <cmath>

#include "cairn/features/multiversion.h"
#include "cairn/features/orb_pattern.h"

namespace cairn {
namespace {

constexpr int kRadius = 15;
constexpr int kRow = 32;  // pixels read a row, from -15 to 16; the last has no weight
constexpr int kTests = 256;

/// Weights of the first moments over the disc: x and y inside, zero outside.
struct MomentWeights {
  alignas(32) std::array<std::array<std::int16_t, kRow>, 2 * kRadius + 1> x = {}, y = {};

  MomentWeights() {
    for (int v = -kRadius; v <= kRadius; ++v) {
      for (int u = -kRadius; u <= kRadius; ++u) {
        // cv::ORB's disc: each row is as wide as the rounded chord, made symmetric about the
        // diagonal so that the disc looks the same from all eight sides.
        if (!inside(std::abs(u), std::abs(v))) continue;
        x[v + kRadius][u + kRadius] = static_cast<std::int16_t>(u);
        y[v + kRadius][u + kRadius] = static_cast<std::int16_t>(v);
      }
    }
  }

  static bool inside(int u, int v) { return v > u ? chord(u) >= v : chord(v) >= u; }
  static int chord(int v) {
    return static_cast<int>(std::lround(std::sqrt(double(kRadius * kRadius - v * v))));
  }
};

/// The pattern with coordinates apart, so that tests are turned many at a time.
struct Pattern {
  alignas(32) std::array<float, 2 * kTests> x, y;  // first pixels of all tests, then second pixels

  Pattern() {
    for (int i = 0; i < kTests; ++i) {
      for (int end = 0; end < 2; ++end) {
        x[i + end * kTests] = kOrbPattern[4 * i + 2 * end];
        y[i + end * kTests] = kOrbPattern[4 * i + 2 * end + 1];
      }
    }
  }
};

const MomentWeights& moment_weights() {
  static const MomentWeights weights;
  return weights;
}

const Pattern& pattern() {
  static const Pattern pattern;
  return pattern;
}

CAIRN_MULTIVERSION
void first_moments(const std::uint8_t* center, std::ptrdiff_t step, const MomentWeights& weights,
                   int& moment_x, int& moment_y) {
  int sum_x = 0, sum_y = 0;
  for (int v = 0; v < 2 * kRadius + 1; ++v) {
    const std::uint8_t* const row = center + (v - kRadius) * step - kRadius;
    for (int u = 0; u < kRow; ++u) {
      const auto intensity = static_cast<std::int16_t>(row[u]);
      sum_x += weights.x[v][u] * intensity;
      sum_y += weights.y[v][u] * intensity;
    }
  }
  moment_x = sum_x;
  moment_y = sum_y;
}

Orientation normalized(double x, double y) {
  constexpr double kUnit = 1 << 14;
  const double norm = std::sqrt(x * x + y * y);
  if (norm == 0) return {};
  return {static_cast<float>(std::nearbyint(x / norm * kUnit) / kUnit),
          static_cast<float>(std::nearbyint(y / norm * kUnit) / kUnit)};
}

/// Where each pixel of the turned pattern lies in memory, relative to the keypoint's pixel.
CAIRN_MULTIVERSION
void turn_pattern(const Pattern& pattern, float cos, float sin, float step,
                  std::int32_t* __restrict offset) {
  // Adding and taking away 1.5 * 2^23 rounds to the nearest integer, ties to even.
  constexpr float kRound = 12582912.0F;
  for (int i = 0; i < 2 * kTests; ++i) {
    const float x = pattern.x[i] * cos - pattern.y[i] * sin;
    const float y = pattern.x[i] * sin + pattern.y[i] * cos;
    const float column = (x + kRound) - kRound;
    const float row = (y + kRound) - kRound;
    offset[i] = static_cast<std::int32_t>(row * step + column);
  }
}

}  // namespace

Orientation intensity_centroid(const std::uint8_t* center, std::ptrdiff_t step) {
  int x = 0, y = 0;
  first_moments(center, step, moment_weights(), x, y);
  return normalized(x, y);
}

Orientation orientation_of(float angle) { return normalized(std::cos(angle), std::sin(angle)); }

float angle_of(const Orientation& orientation) {
  return std::atan2(orientation.sin, orientation.cos);
}

Descriptor describe(const std::uint8_t* blurred_center, std::ptrdiff_t step,
                    const Orientation& orientation) {
  alignas(32) std::array<std::int32_t, 2 * kTests> offset;
  turn_pattern(pattern(), orientation.cos, orientation.sin, static_cast<float>(step),
               offset.data());
  Descriptor descriptor;
  for (int word = 0; word < 4; ++word) {
    const std::int32_t* const first = offset.data() + 64 * word;
    const std::int32_t* const second = first + kTests;
    std::uint64_t bits = 0;
    for (int i = 0; i < 64; ++i) {
      const bool darker = blurred_center[first[i]] < blurred_center[second[i]];
      bits |= static_cast<std::uint64_t>(darker) << i;
    }
    descriptor[word] = bits;
  }
  return descriptor;
}

}  // namespace cairn
