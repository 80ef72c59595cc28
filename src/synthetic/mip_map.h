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

  /// The colour around `uv` (metres) averaged over about `footprint` metres: a blend of the two
  /// nearest levels. (Not one sample of a pixel from this, the next from that: the sharper one says
  /// where things are, and they would creep by a tenth of a pixel as one comes nearer.)
  Colour sample(const Eigen::Vector2f& uv, float footprint) const;
  /// Of the whole.
  const Colour& mean() const { return mean_; }

 private:
  using Texel = std::array<std::uint8_t, 4>;  // red, green, blue, unused
  struct Level {
    int width = 0, height = 0;
    std::vector<Texel> texels;

    /// Between texels. `turns`: whole ones are the same place again.
    Colour at(const Eigen::Vector2f& turns) const;
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
