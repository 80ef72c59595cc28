#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "cairn/synthetic/material.h"

namespace cairn {

/// Linear light of a colour written as sRGB, 0xRRGGBB.
inline Colour srgb(std::uint32_t hex) {
  const auto linear = [&](int shift) {
    const float s = float((hex >> shift) & 255) / 255;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
  };
  return {linear(16), linear(8), linear(0)};
}

// What things in a home and on a street are painted with, sRGB.
inline constexpr std::uint32_t kGlazes[] = {0xf2efe8, 0xe9e2d0, 0x2f4f6f, 0xa33a2c, 0x3f6b4e,
                                            0xd9a441, 0x26282b, 0x7aa6b8, 0xc7765a, 0xb8c4bb,
                                            0x5a4a78, 0xe07b39, 0xf4f4f2, 0x1f7a8c};
inline constexpr std::uint32_t kPlastics[] = {0x1c1d1f, 0x2b2d30, 0x3a3c40,
                                              0xd8d8d6, 0xeceae6, 0x8d9196};
inline constexpr std::uint32_t kFabrics[] = {0x4a5568, 0x6b4f3a, 0x8c8f94, 0x2d3a4a, 0x7d2e2e,
                                             0x53684c, 0xb7a58a, 0x35302d, 0x99a8b5, 0xc8b89c};
inline constexpr std::uint32_t kWoods[] = {0xb98a56, 0x8b5a33, 0x6a4326, 0xd2ab78,
                                           0xa47148, 0xe0c39a, 0x4e3524};
inline constexpr std::uint32_t kMetals[] = {0xb4b7ba, 0x8a8d90, 0x4a4c4f, 0xc9c5bd, 0x26282b};
inline constexpr std::uint32_t kCarPaints[] = {0xf0f0ee, 0x1a1b1d, 0x8f9499, 0x5c6166, 0x9b1c1f,
                                               0x1d3f73, 0x2f5b8f, 0x3d4b3c, 0xb9bcc0, 0x6e1f2a,
                                               0xc7b9a0, 0x14324d, 0xd8a514};
inline constexpr std::uint32_t kPrints[] = {0xd7263d, 0x1b998b, 0x2e294e, 0xf46036, 0xe8c547,
                                            0x30638e, 0x003d5b, 0xedae49, 0x5b8e7d, 0xf7f3e3,
                                            0x222222, 0x8f2d56, 0xffffff, 0x73a580};

}  // namespace cairn
