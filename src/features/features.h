#pragma once

// The features room: what is seen in one picture. ORB keypoints and descriptors, their matching,
// and retrieval of pictures by appearance. It knows no cameras and no map.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace cairn {

/// An oriented FAST corner, in pixels of the full-size picture (level 0, centres at integers).
struct Keypoint {
  float x = 0, y = 0;
  float angle = 0;            ///< radians, x towards y
  std::uint8_t response = 0;  ///< FAST's score: comparable within one octave
  std::int8_t octave = 0;

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
