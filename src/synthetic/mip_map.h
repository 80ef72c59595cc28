#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cairn/synthetic/material.h"

namespace cairn {

/// A texture that is ready to be looked up: linear light, at every size by halves. Texels are kept
/// as square roots of linear light in 8 bits, which is nearly even to the eye and quick to undo.
class MipMap {
 public:
  explicit MipMap(const Texture& texture);

  /// The colour around `uv` (metres) averaged over about `footprint` metres. `dither` in [0, 1)
  /// chooses between the two nearest levels, so that the mean over several is a blend of both.
  Colour sample(const Eigen::Vector2f& uv, float footprint, float dither) const;
  /// Of the whole.
  const Colour& mean() const { return mean_; }

 private:
  using Texel = std::array<std::uint8_t, 4>;  // red, green, blue, unused
  struct Level {
    int width = 0, height = 0;
    std::vector<Texel> texels;
  };

  float texels_per_metre_;
  float repeats_x_, repeats_y_;  // a metre
  std::vector<Level> levels_;
  Colour mean_;
};

/// sRGB (IEC 61966-2-1) to linear light and back, both 0 to 1.
float linear_from_srgb(float encoded);
float srgb_from_linear(float linear);

}  // namespace cairn
