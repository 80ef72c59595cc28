#include "cairn/system/frame_log.h"

#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace cairn {
// A frame where its keyframe carries it.
struct CarriedFrame {
  std::size_t entry;  // of the log
  double timestamp;
  KeyframeId reference;
  SE3 T_wc;
  KeyframeId keyframe = {};        // that it is, if it is one
  std::optional<SE3> anchor = {};  // where it is, if that is known
};

namespace {

// At an anchor it shows by how much frames drifted from their reference keyframe; those in between
// take their share of it, in proportion to time. One entry a frame.
Trajectory share_drift(std::span<const CarriedFrame> frames) {
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
      const CarriedFrame& anchored = frames[next];
      if (!anchored.anchor) continue;
      after = {anchored.timestamp, anchored.keyframe,
               (anchored.T_wc.inverse() * *anchored.anchor).log()};
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

// Of the polynomial through a frame, two before it and two after it, as far as they are near in
// time. Hands tremble at some five hertz: the mean from the frame before to the frame after would
// miss a sixth of that, and make a readout look longer by as much.
Vector6d velocity_at(const Trajectory& trajectory, std::size_t i) {
  constexpr std::size_t kReach = 2;
  std::vector<std::pair<double, Vector6d>> around;  // when, and where from the frame
  const std::size_t end = std::min(i + kReach + 1, trajectory.size());
  for (std::size_t k = i - std::min(i, kReach); k < end; ++k) {
    const double t = trajectory[k].timestamp - trajectory[i].timestamp;
    if (t == 0 || std::abs(t) > kEvenMotion) continue;
    around.emplace_back(t, (trajectory[i].T_wc.inverse() * trajectory[k].T_wc).log());
  }
  Vector6d velocity = Vector6d::Zero();
  for (const auto& [t, way] : around) {
    double weight = 1 / t;  // Lagrange's, derived where the frame is
    for (const auto& [other, _] : around) weight *= other == t ? 1 : other / (other - t);
    velocity += weight * way;
  }
  return velocity;
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

std::vector<CarriedFrame> FrameLog::carried(const Map& map,
                                            std::span<const BuriedKeyframe> buried) const {
  const KeyframeGenealogy genealogy(map, buried);
  std::map<double, KeyframeId> keyframes;
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe& k) { keyframes[k.timestamp()] = id; });
  std::vector<CarriedFrame> frames;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    const std::optional<SE3> T_wr = genealogy.T_wc(entry.reference);
    if (!T_wr) continue;
    frames.push_back({i, entry.timestamp, entry.reference, *T_wr * entry.T_rc});
    const auto keyframe = keyframes.find(entry.timestamp);
    if (keyframe == keyframes.end()) continue;
    frames.back().keyframe = keyframe->second;
    frames.back().anchor = map.keyframes()[keyframe->second].T_wc;
  }
  return frames;
}

std::vector<KeyframeMotion> FrameLog::keyframe_motions(
    const Map& map, std::span<const BuriedKeyframe> buried) const {
  const std::vector<CarriedFrame> frames = carried(map, buried);
  const Trajectory trajectory = share_drift(frames);
  std::vector<KeyframeMotion> motions;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].anchor) motions.push_back({frames[i].keyframe, velocity_at(trajectory, i)});
  }
  return motions;
}

Trajectory FrameLog::final_trajectory(const Map& map,
                                      std::span<const BuriedKeyframe> buried) const {
  std::map<double, const BuriedKeyframe*> graves;
  for (const BuriedKeyframe& b : buried) graves[b.timestamp] = &b;
  std::vector<CarriedFrame> frames = carried(map, buried);
  const Trajectory trajectory = share_drift(frames);
  tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t i) {
    CarriedFrame& frame = frames[i];
    if (frame.anchor) return;
    const auto grave = graves.find(frame.timestamp);
    const SE3& T_wc = trajectory[i].T_wc;
    const Vector6d velocity = velocity_at(trajectory, i);
    const Entry& entry = entries_[frame.entry];
    frame.anchor =
        grave == graves.end()
            ? place(map, sightings_at(entry), entry.last_birth, T_wc, velocity)
            : place(map, grave->second->sightings, grave->second->last_birth, T_wc, velocity);
  });
  spdlog::debug(
      "{} of {} frames found their place in the final map",
      std::count_if(frames.begin(), frames.end(), [](const auto& f) { return !!f.anchor; }),
      frames.size());
  return share_drift(frames);
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
