#include "cairn/mapping/buried_keyframe.h"

namespace cairn {

BuriedKeyframe bury_keyframe(Map& map, KeyframeId id) {
  const Keyframe& keyframe = map.keyframes()[id];
  BuriedKeyframe buried;
  buried.id = id;
  buried.parent = map.covisible(id, 1, 1).front().first;
  buried.T_pk = map.keyframes()[buried.parent].T_wc.inverse() * keyframe.T_wc;
  buried.timestamp = keyframe.timestamp();
  std::vector<char> aligned(keyframe.points.size());
  for (std::size_t i = 0; i < aligned.size(); ++i) {
    const MapPoint* point = map.points().find(keyframe.points[i]);
    aligned[i] = point != nullptr && point->seen_from(id)->aligned();
  }
  buried.sightings = sightings_of(*keyframe.frame, keyframe.points, aligned);
  buried.sightings.shrink_to_fit();  // kept to the end, by the thousand
  buried.last_birth = map.keyframes()[map.newest()].sequence;
  map.erase_keyframe(id);
  return buried;
}

KeyframeGenealogy::KeyframeGenealogy(const Map& map, std::span<const BuriedKeyframe> buried)
    : map_(map) {
  for (const BuriedKeyframe& b : buried) graves_[b.id] = &b;
}

std::optional<SE3> KeyframeGenealogy::T_wc(KeyframeId id) const {
  SE3 T;
  while (true) {
    if (const Keyframe* keyframe = map_.keyframes().find(id)) return keyframe->T_wc * T;
    const auto grave = graves_.find(id);
    if (grave == graves_.end()) return std::nullopt;
    T = grave->second->T_pk * T;
    id = grave->second->parent;
  }
}

}  // namespace cairn
