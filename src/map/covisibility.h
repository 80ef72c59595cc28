#pragma once

#include <span>
#include <utility>
#include <vector>

#include "cairn/map/ids.h"

namespace cairn {

/// How many points any two keyframes both see, kept up to date with each observation: it is asked
/// for far more often than it changes.
class Covisibility {
 public:
  using Shared = std::pair<KeyframeId, int>;

  /// `change` points more, or less where it is negative, that both see.
  void count(KeyframeId a, KeyframeId b, int change);
  /// Of a keyframe, with each other one that shares a point; in order of their ids.
  std::span<const Shared> of(KeyframeId id) const;

 private:
  void count_one_way(KeyframeId from, KeyframeId to, int change);

  std::vector<std::vector<Shared>> shared_;  // by slot; empty once a keyframe sees no points
};

}  // namespace cairn
