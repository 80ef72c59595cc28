#include "cairn/tracking/projection_search.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

struct Claim {
  std::uint16_t distance = 257;
  std::uint32_t point = kNoPoint;
};

}  // namespace

int search_by_projection(const Frame& frame, std::span<const ExpectedPoint> expected,
                         const SearchOptions& options,
                         std::vector<std::uint32_t>& point_of_keypoint) {
  static thread_local std::vector<Claim> claims;
  claims.assign(frame.size(), {});
  for (const ExpectedPoint& e : expected) {
    int best = 257, second = 257, best_octave = -1, second_octave = -1;
    std::uint32_t best_keypoint = 0;
    frame.for_each_near(e.pixel, e.radius, e.min_octave, e.max_octave, [&](std::uint32_t i) {
      if (point_of_keypoint[i] != kNoPoint) return;
      const int distance = hamming(*e.descriptor, frame.features.descriptors[i]);
      if (distance < best) {
        second = best;
        second_octave = best_octave;
        best = distance;
        best_octave = frame.octave(i);
        best_keypoint = i;
      } else if (distance < second) {
        second = distance;
        second_octave = frame.octave(i);
      }
    });
    if (best > options.max_distance) continue;
    if (best_octave == second_octave && best > options.ratio * second) continue;
    Claim& claim = claims[best_keypoint];
    if (best < claim.distance) claim = {static_cast<std::uint16_t>(best), e.index};
  }
  int matches = 0;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    if (claims[i].point == kNoPoint) continue;
    point_of_keypoint[i] = claims[i].point;
    ++matches;
  }
  return matches;
}

}  // namespace cairn
