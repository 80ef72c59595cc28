#pragma once

// The features room: what is seen in one picture. ORB keypoints and descriptors, their matching,
// and retrieval of pictures by appearance. It knows no cameras and no map.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace cairn {

/// A colour in two bytes: five bits of red, six of green, five of blue.
class PackedColour {
 public:
  PackedColour() = default;
  PackedColour(unsigned char r, unsigned char g, unsigned char b)
      : bits_(static_cast<std::uint16_t>((r >> 3) << 11 | (g >> 2) << 5 | b >> 3)) {}

  /// Of 0 to 255, black and white as they were.
  std::array<unsigned char, 3> rgb() const {
    const auto widen = [this](int shift, int most) {
      return static_cast<unsigned char>(((bits_ >> shift & most) * 255 + most / 2) / most);
    };
    return {widen(11, 31), widen(5, 63), widen(0, 31)};
  }
  bool operator==(const PackedColour&) const = default;

 private:
  std::uint16_t bits_ = 0;
};

/// An oriented FAST corner, in pixels of the full-size picture (level 0, centres at integers).
struct Keypoint {
  float x = 0, y = 0;
  float angle = 0;            ///< radians, x towards y
  std::uint8_t response = 0;  ///< FAST's score: comparable within one octave
  std::int8_t octave = 0;
  PackedColour colour = {};  ///< of its pixel, where somebody has looked

  bool operator==(const Keypoint&) const = default;
};

/// 256 binary tests of rotated BRIEF.
using Descriptor = std::array<std::uint64_t, 4>;

inline int hamming(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

/// The features of one picture: element i of both vectors belongs together.
struct Features {
  std::vector<Keypoint> keypoints;
  std::vector<Descriptor> descriptors;

  std::size_t size() const { return keypoints.size(); }
};

}  // namespace cairn
