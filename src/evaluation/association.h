#pragma once

// The evaluation room: how far an estimate is from the truth. Association in time, alignment, ATE,
// RPE, coverage, scale; objects and planes against those of a known world, whose files it reads. It
// must not know how estimates came about.

#include <cstddef>
#include <span>
#include <vector>

namespace cairn {

/// Elements of two lists that belong together.
struct IndexPair {
  std::size_t first = 0, second = 0;
};

/// Pairs each timestamp of the shorter list (of two equally long ones the second) with the nearest
/// of the other, if they differ by `max_difference` seconds at most; `offset` seconds are added to
/// the second list before. Both lists rise. Each timestamp is used once: where two want the same,
/// the nearer one gets it. In order of time.
std::vector<IndexPair> associate(std::span<const double> first, std::span<const double> second,
                                 double max_difference, double offset = 0);

}  // namespace cairn
