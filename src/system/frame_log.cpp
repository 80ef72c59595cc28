#include "cairn/system/frame_log.h"

#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

namespace cairn {
namespace {

struct Carried {
  double timestamp;
  KeyframeId reference;
  SE3 T_wc;
};

// A frame whose place is known, and the keyframe that it is, if it is one.
struct Anchor {
  SE3 T_wc;
  KeyframeId keyframe;
};

// At an anchor it shows by how much frames drifted from their reference keyframe; those in between
// take their share of it, in proportion to time. One entry a frame.
Trajectory share_drift(const std::vector<Carried>& frames,
                       const std::vector<std::optional<Anchor>>& anchors) {
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
      if (!anchors[next]) continue;
      after = {frames[next].timestamp, anchors[next]->keyframe,
               (frames[next].T_wc.inverse() * anchors[next]->T_wc).log()};
      break;
    }
    Vector6d xi = Vector6d::Zero();
    const bool own = before && before->anchor.valid() &&
                     before->anchor == frames[i].reference;  // carried without drift there
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

// From the frame before to the frame after, as far as they are near in time; none where neither is.
Vector6d velocity_at(const Trajectory& trajectory, std::size_t i) {
  const double now = trajectory[i].timestamp;
  const bool first = i == 0 || now - trajectory[i - 1].timestamp > kEvenMotion;
  const bool last = i + 1 == trajectory.size() || trajectory[i + 1].timestamp - now > kEvenMotion;
  const auto& before = trajectory[first ? i : i - 1];
  const auto& after = trajectory[last ? i : i + 1];
  const double dt = after.timestamp - before.timestamp;
  if (!(dt > 0)) return Vector6d::Zero();
  return (before.T_wc.inverse() * after.T_wc).log() / dt;
}

}  // namespace

void FrameLog::add(double timestamp, KeyframeId reference, const SE3& T_rc, const SE3& T_wc,
                   std::span<const Sighting> sightings, std::uint32_t last_birth) {
  entries_.push_back(
      {timestamp, reference, T_rc, seen_.append(std::as_bytes(sightings)), last_birth});
  live_.push_back({timestamp, T_wc});
}

// None where they cannot be read.
std::vector<Sighting> FrameLog::sightings_at(const Entry& entry) const {
  std::vector<Sighting> sightings(entry.sightings.bytes / sizeof(Sighting));
  if (!seen_.read(entry.sightings, std::as_writable_bytes(std::span(sightings)))) return {};
  return sightings;
}

Trajectory FrameLog::final_trajectory(const Map& map,
                                      std::span<const BuriedKeyframe> buried) const {
  const KeyframeGenealogy genealogy(map, buried);
  std::map<double, KeyframeId> keyframes;
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe& k) { keyframes[k.timestamp()] = id; });
  std::map<double, const BuriedKeyframe*> graves;
  for (const BuriedKeyframe& b : buried) graves[b.timestamp] = &b;
  std::vector<const Entry*> entries;
  std::vector<Carried> frames;
  std::vector<std::optional<Anchor>> anchors;
  for (const Entry& entry : entries_) {
    const std::optional<SE3> T_wr = genealogy.T_wc(entry.reference);
    if (!T_wr) continue;
    entries.push_back(&entry);
    frames.push_back({entry.timestamp, entry.reference, *T_wr * entry.T_rc});
    anchors.emplace_back();
    const auto keyframe = keyframes.find(entry.timestamp);
    if (keyframe == keyframes.end()) continue;
    anchors.back() = {map.keyframes()[keyframe->second].T_wc, keyframe->second};
  }
  const Trajectory carried = share_drift(frames, anchors);
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    if (anchors[i]) return;
    const Entry& entry = *entries[i];
    const auto grave = graves.find(entry.timestamp);
    const SE3& T_wc = carried[i].T_wc;
    const Vector6d velocity = velocity_at(carried, i);
    const auto placed =
        grave == graves.end()
            ? place(map, sightings_at(entry), entry.last_birth, T_wc, velocity)
            : place(map, grave->second->sightings, grave->second->last_birth, T_wc, velocity);
    if (placed) anchors[i] = {*placed, {}};
  });
  spdlog::debug("{} of {} frames found their place in the final map",
                std::count_if(anchors.begin(), anchors.end(), [](const auto& a) { return !!a; }),
                frames.size());
  return share_drift(frames, anchors);
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
