// The planes of the map.

#include <algorithm>

#include "cairn/map/map.h"

namespace cairn {
namespace {

PlaneObservation observation_of(KeyframeId keyframe, const SeenPlane& seen) {
  return {keyframe, seen.plane.facing_origin().normal(), seen.centroid, seen.sigma_angle,
          seen.sigma_offset};
}

}  // namespace

PlaneId Map::add_plane(KeyframeId keyframe, const SeenPlane& seen) {
  PlaneLandmark landmark;
  landmark.reference = keyframe;
  landmark.plane = seen.plane.facing_origin();
  const PlaneId id = planes_.insert(std::move(landmark));
  observe_plane(id, keyframe, seen);
  return id;
}

void Map::observe_plane(PlaneId id, KeyframeId keyframe, const SeenPlane& seen) {
  PlaneLandmark& landmark = planes_[id];
  landmark.votes[seen.label] += seen.score;
  // A picture may show it in several parts.
  const std::uint32_t now = keyframes_[keyframe].sequence;
  landmark.sightings += landmark.sightings == 0 || now != landmark.last_seen;
  landmark.last_seen = std::max(landmark.last_seen, now);
  const SE3 T_rk = keyframes_[landmark.reference].T_wc.inverse() * keyframes_[keyframe].T_wc;
  std::vector<Eigen::Vector3d> corners = landmark.outline;
  for (const Eigen::Vector3d& corner : seen.outline) corners.push_back(T_rk * corner);
  landmark.outline = convex_outline(landmark.plane, corners);
  if (!landmark.seen_by(keyframe)) landmark.observations.push_back(observation_of(keyframe, seen));
}

void Map::erase_plane(PlaneId id) {
  const std::vector<PointId> members = planes_[id].points;
  for (const PointId point : members) {
    points_[point].plane = {};
    if (points_[point].assumed) erase_point(point);  // nothing else says where it is
  }
  std::erase_if(relations_, [&](const RelatedPlanes& r) { return r.a == id || r.b == id; });
  planes_.erase(id);
}

void Map::set_plane_of(PointId point, PlaneId plane) {
  PlaneId& now = points_[point].plane;
  if (now == plane) return;
  if (now.valid()) std::erase(planes_[now].points, point);
  now = plane;
  if (now.valid()) planes_[now].points.push_back(point);
}

void Map::merge_planes(PlaneId from, PlaneId into) {
  const PlaneLandmark moved = planes_[from];
  PlaneLandmark& target = planes_[into];
  const SE3 T_rf = keyframes_[target.reference].T_wc.inverse() * keyframes_[moved.reference].T_wc;
  for (const auto& [label, votes] : moved.votes) target.votes[label] += votes;
  target.sightings = std::max(target.sightings, moved.sightings);  // many of them are the same
  target.last_seen = std::max(target.last_seen, moved.last_seen);
  for (const PlaneObservation& o : moved.observations) {
    if (!target.seen_by(o.keyframe)) target.observations.push_back(o);
  }
  std::vector<Eigen::Vector3d> corners = target.outline;
  for (const Eigen::Vector3d& corner : moved.outline) corners.push_back(T_rf * corner);
  target.outline = convex_outline(target.plane, corners);
  for (const PointId point : moved.points) set_plane_of(point, into);
  erase_plane(from);
}

Plane Map::plane_in_world(PlaneId id) const {
  const PlaneLandmark& landmark = planes_[id];
  return landmark.plane.transformed(keyframes_[landmark.reference].T_wc);
}

std::vector<Eigen::Vector3d> Map::outline_in_world(PlaneId id) const {
  const PlaneLandmark& landmark = planes_[id];
  std::vector<Eigen::Vector3d> outline = landmark.outline;
  for (Eigen::Vector3d& corner : outline) corner = keyframes_[landmark.reference].T_wc * corner;
  return outline;
}

// What the keyframe saw of planes is still true once it is gone: a neighbour takes it over, unless
// it saw the plane itself. Without a neighbour the planes that hang on the keyframe go with it.
void Map::move_planes(KeyframeId from, KeyframeId to) {
  const SE3 T_tf = to.valid() ? keyframes_[to].T_wc.inverse() * keyframes_[from].T_wc : SE3();
  planes_.for_each([&](PlaneId id, PlaneLandmark& landmark) {
    const bool to_sees = landmark.seen_by(to);
    std::erase_if(landmark.observations, [&](const PlaneObservation& o) {
      return o.keyframe == from && (to_sees || !to.valid());
    });
    for (PlaneObservation& o : landmark.observations) {
      if (o.keyframe != from) continue;
      o.keyframe = to;
      o.normal = T_tf.rotation() * o.normal;
      o.centroid = T_tf * o.centroid;
    }
    if (landmark.reference != from) return;
    if (to.valid()) {
      change_reference(landmark, to, T_tf);
    } else {
      erase_plane(id);
    }
  });
}

}  // namespace cairn
