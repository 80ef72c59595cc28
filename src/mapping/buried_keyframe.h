#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/mapping/sighting.h"

namespace cairn {

/// A keyframe that is gone, and where it was from one that stays or was buried later: frames are
/// carried by it.
struct BuriedKeyframe {
  KeyframeId id, parent;
  SE3 T_pk;  ///< keyframe to parent
  double timestamp = 0;
  /// What it saw when it was buried: more, and more exactly, than when it was tracked.
  std::vector<Sighting> sightings = {};
  std::uint32_t last_birth = 0;  ///< as in `place`, at that time
};

/// Takes a keyframe out of the map. Its parent is the keyframe that shares most points with it.
BuriedKeyframe bury_keyframe(Map& map, KeyframeId id);

/// The pose of a keyframe, alive or buried; nothing if it never was in this map.
class KeyframeGenealogy {
 public:
  KeyframeGenealogy(const Map& map, std::span<const BuriedKeyframe> buried);
  std::optional<SE3> T_wc(KeyframeId id) const;

 private:
  const Map& map_;
  std::map<KeyframeId, const BuriedKeyframe*> graves_;
};

}  // namespace cairn
