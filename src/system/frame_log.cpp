#include "cairn/system/frame_log.h"

#include <algorithm>
#include <map>

namespace cairn {

void FrameLog::add(double timestamp, KeyframeId reference, const SE3& T_rc, const SE3& T_wc) {
  entries_.push_back({timestamp, reference, T_rc});
  live_.push_back({timestamp, T_wc});
}

Trajectory FrameLog::final_trajectory(const Map& map,
                                      std::span<const BuriedKeyframe> buried) const {
  std::map<double, KeyframeId> own;  // frames that are keyframes themselves
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& k) { own[k.timestamp()] = id; });
  std::map<KeyframeId, const BuriedKeyframe*> graves;
  for (const BuriedKeyframe& b : buried) graves[b.id] = &b;

  Trajectory result;
  for (const Entry& entry : entries_) {
    if (const auto it = own.find(entry.timestamp); it != own.end()) {
      result.push_back({entry.timestamp, map.keyframes()[it->second].T_wc});
      continue;
    }
    KeyframeId id = entry.reference;
    SE3 T = entry.T_rc;
    while (!map.keyframes().contains(id)) {
      const auto grave = graves.find(id);
      if (grave == graves.end()) break;
      T = grave->second->T_pk * T;
      id = grave->second->parent;
    }
    if (const Keyframe* k = map.keyframes().find(id)) {
      result.push_back({entry.timestamp, k->T_wc * T});
    }
  }
  return result;
}

Trajectory keyframe_trajectory(const Map& map) {
  Trajectory result;
  map.keyframes().for_each(
      [&](KeyframeId, const Keyframe& k) { result.push_back({k.timestamp(), k.T_wc}); });
  std::sort(result.begin(), result.end(),
            [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
  return result;
}

}  // namespace cairn
