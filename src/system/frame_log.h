#pragma once

#include <span>
#include <vector>

#include "cairn/geometry/trajectory.h"
#include "cairn/mapping/mapper.h"

namespace cairn {

/// Every tracked frame, relative to the keyframe that carries it.
class FrameLog {
 public:
  /// `T_rc`: camera to the reference keyframe; `T_wc`: as known now.
  void add(double timestamp, KeyframeId reference, const SE3& T_rc, const SE3& T_wc);

  /// Each frame where its keyframe, or what that was merged into, lies in the map as it is now.
  Trajectory final_trajectory(const Map& map, std::span<const BuriedKeyframe> buried) const;
  const Trajectory& live_trajectory() const { return live_; }

 private:
  struct Entry {
    double timestamp;
    KeyframeId reference;
    SE3 T_rc;
  };
  std::vector<Entry> entries_;
  Trajectory live_;
};

/// The keyframes of a map in order of time.
Trajectory keyframe_trajectory(const Map& map);

}  // namespace cairn
