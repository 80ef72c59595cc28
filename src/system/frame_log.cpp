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
  const KeyframeGenealogy genealogy(map, buried);
  std::map<double, KeyframeId> anchors;  // frames that are keyframes themselves
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& k) { anchors[k.timestamp()] = id; });
  for (const BuriedKeyframe& b : buried) {
    if (b.resected) anchors[b.timestamp] = b.id;
  }
  struct Carried {
    double timestamp;
    KeyframeId reference;
    SE3 T_wc;
  };
  std::vector<Carried> frames;
  for (const Entry& entry : entries_) {
    const std::optional<SE3> T_wr = genealogy.T_wc(entry.reference);
    if (T_wr) frames.push_back({entry.timestamp, entry.reference, *T_wr * entry.T_rc});
  }
  // At an anchor it shows by how much frames drifted from their reference keyframe; those in
  // between take their share of it, in proportion to time.
  struct Drift {
    double timestamp;
    KeyframeId anchor;
    Vector6d xi;  // in the camera
  };
  std::optional<Drift> before;
  Trajectory result;
  std::size_t next = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::optional<Drift> after;
    for (next = std::max(next, i); next < frames.size(); ++next) {
      const auto anchor = anchors.find(frames[next].timestamp);
      if (anchor == anchors.end()) continue;
      const SE3 T_wa = genealogy.T_wc(anchor->second).value();
      after = {frames[next].timestamp, anchor->second, (frames[next].T_wc.inverse() * T_wa).log()};
      break;
    }
    Vector6d xi = Vector6d::Zero();
    const bool own =
        before && before->anchor == frames[i].reference;  // carried without drift there
    const Vector6d at_before = before && !own ? before->xi : Vector6d::Zero();
    if (after && (before || next == i)) {
      const double share =
          before && after->timestamp > before->timestamp
              ? (frames[i].timestamp - before->timestamp) / (after->timestamp - before->timestamp)
              : 1.0;
      xi = (1 - share) * at_before + share * after->xi;
    } else if (before) {
      xi = at_before;
    }
    result.push_back({frames[i].timestamp, frames[i].T_wc * SE3::exp(xi)});
    if (after && next == i) {
      before = after;
      ++next;
    }
  }
  return result;
}

Trajectory keyframe_trajectory(const Map& map) {
  Trajectory result;
  map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
    result.push_back({k.timestamp(), k.T_wc});
  });
  std::sort(result.begin(), result.end(),
            [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
  return result;
}

}  // namespace cairn
