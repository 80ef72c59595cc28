#pragma once

#include <span>
#include <string>

#include "cairn/geometry/sampler.h"
#include "cairn/synthetic/prints/colours.h"

namespace cairn {

/// Draws the random parameters of one thing.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : sampler_(seed) {}

  float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(sampler_.uniform());
  }
  int below(int n) { return sampler_.below(n); }
  bool chance(float probability) { return uniform(0, 1) < probability; }
  std::uint64_t seed() { return sampler_.next(); }
  /// One colour of a palette, a little lighter or darker than it is there.
  Colour colour(std::span<const std::uint32_t> palette) {
    return srgb(palette[below(int(palette.size()))]) * uniform(0.85f, 1.0f);
  }
  /// A word that means nothing.
  std::string word(int shortest = 3, int longest = 8);

 private:
  Sampler sampler_;
};

}  // namespace cairn
