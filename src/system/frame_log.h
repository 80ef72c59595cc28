#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cairn/geometry/trajectory.h"
#include "cairn/mapping/mapper.h"
#include "cairn/mapping/sighting.h"
#include "cairn/system/scratch_file.h"

namespace cairn {

struct CarriedFrame;

/// Every tracked frame: where it is from the keyframe that carries it, and what it saw.
class FrameLog {
 public:
  /// `T_rc`: camera to the reference keyframe; `T_wc`: as known now. `last_birth`: as in `place`.
  void add(double timestamp, KeyframeId reference, const SE3& T_rc, const SE3& T_wc,
           std::span<const Sighting> sightings = {}, std::uint32_t last_birth = 0);

  /// Each frame where the final map says that it was: keyframes where they are, others where they
  /// see what they saw (`buried` ones when they were buried); those that saw too little keep their
  /// place between frames that did not.
  Trajectory final_trajectory(const Map& map, std::span<const BuriedKeyframe> buried) const;
  /// How the keyframes of the map moved, as the frames just before and after them show it.
  std::vector<KeyframeMotion> keyframe_motions(const Map& map,
                                               std::span<const BuriedKeyframe> buried) const;
  const Trajectory& live_trajectory() const { return live_; }

 private:
  struct Entry {
    double timestamp;
    KeyframeId reference;
    SE3 T_rc;
    ScratchFile::Extent sightings;
    std::uint32_t last_birth;
  };

  std::vector<CarriedFrame> carried(const Map& map, std::span<const BuriedKeyframe> buried) const;
  std::vector<Sighting> sightings_at(const Entry& entry) const;

  std::vector<Entry> entries_;
  Trajectory live_;
  ScratchFile seen_;
};

/// The keyframes of a map in order of time.
Trajectory keyframe_trajectory(const Map& map);

}  // namespace cairn
