#pragma once

#include "cairn/geometry/se3.h"

namespace cairn {

/// Camera to world: at `position`, looking at `target`, upright but for `roll` (radians).
SE3 looking_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target, double roll = 0);

/// How a hand that holds a camera wanders: sums of slow waves, smooth, different for each seed and
/// never the same again within minutes.
class HandMotion {
 public:
  explicit HandMotion(std::uint64_t seed) : seed_(seed) {}

  /// In about [-1, 1], slow: a period of some `period` seconds. `channel`: another motion each.
  double wander(double t, int channel, double period) const;
  /// The small and quick part of a hand's motion, about 5 mm and 0.3 degrees, times `strength`.
  SE3 tremble(double t, double strength = 1) const;

 private:
  std::uint64_t seed_;
};

}  // namespace cairn
