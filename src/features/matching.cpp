#include "cairn/features/matching.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace cairn {

BestMatch best_match(const Descriptor& descriptor, std::span<const Descriptor> candidates) {
  BestMatch best;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    best.offer(i, hamming(descriptor, candidates[i]));
  }
  return best;
}

BestMatch best_match(const Descriptor& descriptor, std::span<const Descriptor> descriptors,
                     std::span<const std::uint32_t> candidates) {
  BestMatch best;
  for (const std::uint32_t i : candidates) best.offer(i, hamming(descriptor, descriptors[i]));
  return best;
}

void hamming_distances(const Descriptor& descriptor, std::span<const Descriptor> candidates,
                       std::span<std::uint16_t> distances) {
  assert(candidates.size() == distances.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    distances[i] = static_cast<std::uint16_t>(hamming(descriptor, candidates[i]));
  }
}

int RotationHistogram::bin(float angle_first, float angle_second) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  float turn = (angle_second - angle_first) / kTurn;
  turn -= std::floor(turn);
  // Bins are centred on multiples of their width, so that no turn at all is not on an edge.
  return static_cast<int>(std::lround(turn * kBins)) % kBins;
}

void RotationHistogram::choose() {
  std::array<int, kBins> order;
  for (int i = 0; i < kBins; ++i) order[i] = i;
  std::partial_sort(order.begin(), order.begin() + 3, order.end(), [&](int a, int b) {
    return counts_[a] != counts_[b] ? counts_[a] > counts_[b] : a < b;
  });
  kept_ = {};
  for (int i = 0; i < 3; ++i) {
    kept_[order[i]] = counts_[order[i]] > 0 && 10 * counts_[order[i]] >= counts_[order[0]];
  }
}

void filter_by_rotation(std::span<const Keypoint> first, std::span<const Keypoint> second,
                        std::vector<Match>& matches) {
  RotationHistogram histogram;
  for (const Match& match : matches) {
    histogram.add(first[match.first].angle, second[match.second].angle);
  }
  histogram.choose();
  std::erase_if(matches, [&](const Match& match) {
    return !histogram.consistent(first[match.first].angle, second[match.second].angle);
  });
}

std::vector<Match> match_mutual(const Features& first, const Features& second,
                                const MatchOptions& options) {
  // Each distance is computed once and offered to both sides.
  std::vector<BestMatch> best_second(second.size());
  std::vector<BestMatch> best_first(first.size());
  std::vector<std::uint16_t> distances(second.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    hamming_distances(first.descriptors[i], second.descriptors, distances);
    for (std::uint32_t j = 0; j < second.size(); ++j) {
      best_first[i].offer(j, distances[j]);
      best_second[j].offer(i, distances[j]);
    }
  }
  std::vector<Match> matches;
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    const BestMatch& best = best_first[i];
    if (!best.found() || best_second[best.index].index != i) continue;
    if (best.distance > options.max_distance) continue;
    if (options.ratio < 1 && best.distance >= options.ratio * best.second_distance) continue;
    matches.push_back({i, best.index, best.distance});
  }
  if (options.check_orientation) {
    filter_by_rotation(first.keypoints, second.keypoints, matches);
  }
  return matches;
}

}  // namespace cairn
