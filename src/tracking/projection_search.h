#pragma once

// The tracking room: a frame and a MapView in, a pose out; how a map begins, and how a lost camera
// finds its place again. It changes no map.

#include <cstdint>
#include <span>
#include <vector>

#include "cairn/map/map_view.h"
#include "cairn/map/visibility.h"

namespace cairn {

/// Where a map point is expected in a frame.
struct ExpectedPoint {
  std::uint32_t index = 0;  ///< of the point, in the caller's terms
  Eigen::Vector2f pixel;
  float radius = 0;  ///< pixels: how far from it to look
  std::int16_t min_octave = 0, max_octave = 0;
  const Descriptor* descriptor = nullptr;
};

struct SearchOptions {
  int max_distance = 100;  ///< Hamming, of 256
  double ratio = 1.0;      ///< best to second best of the same octave; 1 turns the test off
};

constexpr std::uint32_t kNoPoint = MapView::kNone;

/// Finds expected points among the keypoints of a frame by descriptor. `point_of_keypoint` (one
/// entry a keypoint) is extended: taken keypoints are left alone. A keypoint that two points want
/// goes to the nearer descriptor. Returns how many were matched.
int search_by_projection(const Frame& frame, std::span<const ExpectedPoint> expected,
                         const SearchOptions& options,
                         std::vector<std::uint32_t>& point_of_keypoint);

}  // namespace cairn
