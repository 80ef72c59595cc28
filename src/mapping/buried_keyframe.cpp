#include "cairn/mapping/buried_keyframe.h"

#include <cmath>
#include <limits>

#include "cairn/optimization/pose_adjustment.h"

namespace cairn {
namespace {

constexpr int kMinInliers = 30;
constexpr double kFraction = 8;             // parts of a pixel that are kept
constexpr std::size_t kMaxSightings = 256;  // 2 kB; more hardly make the pose any better

// Keeps every n-th, so that all parts of the picture and all octaves stay.
template <class T>
void thin_out(std::vector<T>& values) {
  if (values.size() > kMaxSightings) {
    for (std::size_t i = 0; i < kMaxSightings; ++i) {
      values[i] = values[i * values.size() / kMaxSightings];
    }
    values.resize(kMaxSightings);
  }
  values.shrink_to_fit();
}

}  // namespace

BuriedKeyframe bury_keyframe(Map& map, KeyframeId id) {
  const Keyframe& keyframe = map.keyframes()[id];
  BuriedKeyframe buried;
  buried.id = id;
  buried.last_birth = map.keyframes()[map.newest()].sequence;
  buried.timestamp = keyframe.timestamp();
  buried.parent = map.covisible(id, 1).front().first;
  buried.T_pk = map.keyframes()[buried.parent].T_wc.inverse() * keyframe.T_wc;
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    const Eigen::Vector2d pixel = keyframe.frame->pixel(i) * kFraction;
    constexpr double kLimit = std::numeric_limits<std::int16_t>::max();
    if (pixel.cwiseAbs().maxCoeff() > kLimit) continue;
    buried.sightings.push_back({keyframe.points[i],
                                static_cast<std::int16_t>(std::lround(pixel.x())),
                                static_cast<std::int16_t>(std::lround(pixel.y()))});
    buried.octaves.push_back(static_cast<std::uint8_t>(keyframe.frame->octave(i)));
  }
  thin_out(buried.sightings);
  thin_out(buried.octaves);
  map.erase_keyframe(id);
  return buried;
}

void resect_buried_keyframes(const Map& map, std::span<BuriedKeyframe> buried) {
  const Pinhole& pinhole = map.view().pinhole();
  // From here on each hangs on a living keyframe alone, so that moving one moves no other.
  std::vector<std::pair<KeyframeId, SE3>> places;
  const KeyframeGenealogy genealogy(map, buried);
  for (const BuriedKeyframe& b : buried) {
    places.emplace_back(genealogy.living(b.id).value_or(KeyframeId{}), SE3());
    if (places.back().first.valid()) places.back().second = genealogy.T_wc(b.id).value();
  }
  std::vector<PoseObservation> observations;
  std::vector<char> inlier;
  for (std::size_t i = 0; i < buried.size(); ++i) {
    BuriedKeyframe& b = buried[i];
    SE3 T_wc = places[i].second;
    if (!places[i].first.valid()) continue;
    const SE3 T_wp = map.keyframes()[places[i].first].T_wc;
    b.parent = places[i].first;
    b.T_pk = T_wp.inverse() * T_wc;
    const SE3 T_cw = T_wc.inverse();
    observations.clear();
    for (std::size_t k = 0; k < b.sightings.size(); ++k) {
      const BuriedKeyframe::Sighting& s = b.sightings[k];
      const MapPoint* point = map.points().find(s.point);
      if (point == nullptr || point->born > b.last_birth) continue;
      const Eigen::Vector3d X = T_cw * point->position;
      if (!(X.z() > 0)) continue;
      // The pixel that the camera would have seen if the calibration were right.
      const Eigen::Vector2d bend = map.lens().project(pinhole, X) - pinhole.project(X);
      const Eigen::Vector2d pixel = Eigen::Vector2d(s.x, s.y) / kFraction;
      observations.push_back({point->position, pixel - bend, map.view().sigma(b.octaves[k])});
    }
    const PoseAdjustmentSummary summary = adjust_pose(observations, pinhole, T_wc, inlier);
    if (!summary.usable || summary.inliers < kMinInliers) continue;
    b.T_pk = T_wp.inverse() * T_wc;
    b.resected = true;
  }
}

KeyframeGenealogy::KeyframeGenealogy(const Map& map, std::span<const BuriedKeyframe> buried)
    : map_(map) {
  for (const BuriedKeyframe& b : buried) graves_[b.id] = &b;
}

std::optional<KeyframeId> KeyframeGenealogy::living(KeyframeId id) const {
  while (!map_.keyframes().contains(id)) {
    const auto grave = graves_.find(id);
    if (grave == graves_.end()) return std::nullopt;
    id = grave->second->parent;
  }
  return id;
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
