#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cairn/features/features.h"
#include "cairn/features/keypoint_grid.h"

namespace cairn {

/// The nearest and second nearest of some candidates by Hamming distance.
struct BestMatch {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr int kFar = 257;  ///< farther than any two descriptors

  std::uint32_t index = kNone;  ///< of the nearest; of equally near ones the first
  std::uint32_t second_index = kNone;
  int distance = kFar;         ///< bits
  int second_distance = kFar;  ///< bits

  bool found() const { return index != kNone; }
  /// Near, and clearly nearer than the second: distance < ratio * second_distance.
  bool accepted(int max_distance, double ratio) const {
    return distance <= max_distance && distance < ratio * second_distance;
  }
  /// One more candidate.
  void offer(std::uint32_t candidate, int candidate_distance) {
    if (candidate_distance < distance) {
      second_index = index;
      second_distance = distance;
      index = candidate;
      distance = candidate_distance;
    } else if (candidate_distance < second_distance) {
      second_index = candidate;
      second_distance = candidate_distance;
    }
  }
};

/// Among all of `candidates`.
BestMatch best_match(const Descriptor& descriptor, std::span<const Descriptor> candidates);

/// Among those of `descriptors` that `candidates` lists; indices are into `descriptors`.
BestMatch best_match(const Descriptor& descriptor, std::span<const Descriptor> descriptors,
                     std::span<const std::uint32_t> candidates);

/// Hamming distances of one descriptor to many, in bits. `distances`: as many as `candidates`.
void hamming_distances(const Descriptor& descriptor, std::span<const Descriptor> candidates,
                       std::span<std::uint16_t> distances);

/// Features `first` and `second` of two pictures, `distance` bits apart.
struct Match {
  std::uint32_t first = 0, second = 0;
  int distance = 0;
};

/// Between two pictures of one scene most keypoints turn by the same angle (the camera's roll).
/// Collects the turns of matches in bins of 12 degrees and tells which are in the three fullest.
class RotationHistogram {
 public:
  static constexpr int kBins = 30;

  void clear() { counts_ = {}; }
  /// Angles in radians.
  void add(float angle_first, float angle_second) { ++counts_[bin(angle_first, angle_second)]; }
  /// Whether a match turns as most do. The second and third fullest bin count if they hold at least
  /// a tenth of the fullest. Call choose() after the last add().
  bool consistent(float angle_first, float angle_second) const {
    return kept_[bin(angle_first, angle_second)];
  }
  void choose();

  static int bin(float angle_first, float angle_second);

 private:
  std::array<int, kBins> counts_ = {};
  std::array<bool, kBins> kept_ = {};
};

/// Removes the matches whose keypoints turn otherwise than most, in place, order kept.
void filter_by_rotation(std::span<const Keypoint> first, std::span<const Keypoint> second,
                        std::vector<Match>& matches);

struct MatchOptions {
  int max_distance = 50;          ///< bits of 256
  double ratio = 0.8;             ///< nearest over second nearest distance, below; 1: no test
  bool check_orientation = true;  ///< only matches that turn as most do
};

/// Pairs of features that are each other's nearest, among all; in order of `first`.
std::vector<Match> match_mutual(const Features& first, const Features& second,
                                const MatchOptions& options = {});

}  // namespace cairn
