#include "cairn/mapping/point_alignment.h"

#include "cairn/mapping/surface_normals.h"

namespace cairn {
namespace {

// Keyframes for which a point is new: its neighbours, and they say how its surface lies, still
// move.
constexpr std::uint32_t kNew = 3;
// Later they know it ever better. Each turn of a facet moves where its point is found, so small
// ones do not count.
constexpr double kTurned = 0.985;  // cosine of 10 degrees

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

// Where a point is found depends on how its facet lies.
void align_anew(const Map& map, MapPoint& point) {
  for (Observation& o : point.observations) {
    if (map.keyframes()[o.keyframe].picture) o.patch = PatchState::kUntried;
  }
}

// A plane says better than the neighbours how a point's surface lies.
void turn_patches(Map& map, const Keyframe& keyframe) {
  const SurfaceNormals normals(map, keyframe);
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    MapPoint& point = map.points()[keyframe.points[i]];
    if (!point.patch) continue;
    const Eigen::Vector3d normal =
        point.plane.valid() ? map.plane_in_world(point.plane).normal() : normals.at(i);
    const bool turned = std::abs(point.patch->normal().dot(normal)) < kTurned;
    if (!turned && !point.plane.valid() && keyframe.sequence > point.born + kNew) continue;
    point.patch = std::make_shared<PointPatch>(point.patch->turned(normal));
    if (turned) align_anew(map, point);
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
    Observation* const observation = point.seen_from(id);
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
  turn_patches(map, keyframe);
  map.keyframes().for_each([&](KeyframeId id, Keyframe& k) {
    if (k.picture) align_keypoints(map, k, id);
  });
}

}  // namespace cairn
