#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// A keyframe that is gone, and where it was from one that stays or was buried later. It remembers
/// what it saw, so that it finds its place in the final map: frames are carried by it.
struct BuriedKeyframe {
  struct Sighting {
    PointId point;              ///< still the same one if born by `last_birth`
    std::int16_t x = 0, y = 0;  ///< eighths of a pixel
  };
  KeyframeId id, parent;
  SE3 T_pk;  ///< keyframe to parent
  double timestamp = 0;
  std::uint32_t last_birth = 0;  ///< sequence number of the newest keyframe when it was buried
  std::vector<Sighting> sightings = {};
  std::vector<std::uint8_t> octaves = {};  ///< one a sighting
  bool resected = false;                   ///< T_pk comes from the final map's points
};

/// Takes a keyframe out of the map. Its parent is the keyframe that shares most points with it.
BuriedKeyframe bury_keyframe(Map& map, KeyframeId id);

/// Places buried keyframes in the map as it is now, from the points they saw.
void resect_buried_keyframes(const Map& map, std::span<BuriedKeyframe> buried);

/// The pose of a keyframe, alive or buried; nothing if it never was in this map.
class KeyframeGenealogy {
 public:
  KeyframeGenealogy(const Map& map, std::span<const BuriedKeyframe> buried);
  std::optional<SE3> T_wc(KeyframeId id) const;
  /// The keyframe itself, or the first of its ancestors that is alive.
  std::optional<KeyframeId> living(KeyframeId id) const;

 private:
  const Map& map_;
  std::map<KeyframeId, const BuriedKeyframe*> graves_;
};

}  // namespace cairn
