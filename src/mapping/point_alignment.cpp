#include "cairn/mapping/point_alignment.h"

#include <algorithm>

namespace cairn {
namespace {

// New points are looked for in about so many of the keyframes before; a picture takes a megabyte.
constexpr std::uint32_t kPictures = 20;

void cut_new_patches(Map& map, const Keyframe& keyframe, KeyframeId id) {
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    MapPoint& point = map.points()[keyframe.points[i]];
    if (point.patch) continue;
    point.patch =
        cut_patch(*keyframe.picture, map.view().pinhole(), keyframe.frame->sighted_pixel(i),
                  keyframe.frame->octave(i), keyframe.T_wc, point.position);
    if (!point.patch) continue;
    // There it is where the patch was cut, and where others were found they were by corners.
    for (Observation& o : point.observations) {
      o.patch = o.keyframe == id ? PatchState::kFound : PatchState::kUntried;
    }
  }
}

// Trackers may look at the frame: what moves is a copy of it.
void align_keypoints(Map& map, Keyframe& keyframe, KeyframeId id) {
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::shared_ptr<Frame> moved;
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    MapPoint& point = map.points()[keyframe.points[i]];
    if (!point.patch) continue;
    const auto observation = std::find_if(point.observations.begin(), point.observations.end(),
                                          [&](const Observation& o) { return o.keyframe == id; });
    if (observation->patch != PatchState::kUntried) continue;
    const Eigen::Vector2d pixel = keyframe.frame->sighted_pixel(i);
    const auto found = find_patch(*point.patch, *keyframe.picture, map.view().pinhole(), T_cw,
                                  point.position, pixel);
    observation->patch = found ? PatchState::kFound : PatchState::kMissed;
    if (!found) continue;
    if (!moved) moved = std::make_shared<Frame>(*keyframe.frame);
    moved->move(i, *found - pixel);
  }
  if (moved) keyframe.frame = std::move(moved);
}

}  // namespace

void align_points(Map& map, KeyframeId newest) {
  const Keyframe& keyframe = map.keyframes()[newest];
  if (!keyframe.picture) return;
  cut_new_patches(map, keyframe, newest);
  map.keyframes().for_each([&](KeyframeId id, Keyframe& k) {
    if (k.sequence + kPictures <= keyframe.sequence) k.picture = nullptr;
    if (k.picture) align_keypoints(map, k, id);
  });
}

}  // namespace cairn
