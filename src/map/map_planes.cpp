// The planes of the map.

#include <algorithm>
#include <utility>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {
namespace {

constexpr std::size_t kMostBuried = 200;  // outlines of a plane: each is looked at in each keyframe

PlaneObservation observation_of(KeyframeId keyframe, const SeenPlane& seen) {
  PlaneObservation o{keyframe, seen.plane.facing_origin().normal(), seen.centroid, seen.sigma_angle,
                     seen.sigma_offset};
  o.outlines = {seen.outline};
  o.keypoints = seen.keypoints;
  o.inner = seen.inner;
  o.beside = seen.beside;
  return o;
}

// Every other one goes when they are many, so that they stay spread over time.
void bury(PlaneLandmark& landmark, PlaneOutlines view) {
  std::vector<PlaneOutlines>& views = landmark.buried_views;
  views.push_back(std::move(view));
  if (views.size() <= kMostBuried) return;
  std::size_t index = 0;
  std::erase_if(views, [&](const PlaneOutlines&) { return index++ % 2 == 0; });
}

template <class VotesOf>
void count_votes(const Keyframe& keyframe, const PlaneObservation& o, VotesOf&& votes_of) {
  if (o.keypoints.empty()) return;  // it stands for one that is gone
  // A detector was asked for corners: what it would say of what was added, it never said.
  std::vector<int MaskVotes::*> where(keyframe.frame->corners(), &MaskVotes::outside);
  for (const std::uint32_t i : o.beside) where[i] = &MaskVotes::beside;
  for (const std::uint32_t i : o.keypoints) where[i] = &MaskVotes::rim;
  for (const std::uint32_t i : o.inner) where[i] = &MaskVotes::inside;
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (keyframe.points[i].valid()) ++(votes_of(keyframe.points[i]).*where[i]);
  }
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
  const std::uint32_t now = keyframes_[keyframe].sequence;
  landmark.sightings += landmark.sightings == 0 || now != landmark.last_seen;
  landmark.last_seen = now;
  landmark.add(observation_of(keyframe, seen));
  update_outline(id);
}

template <class Function>
void Map::for_each_view(PlaneId id, Function&& f) const {
  const PlaneLandmark& landmark = planes_[id];
  for (const PlaneOutlines& seen : landmark.buried_views) f(seen.T_rk, seen.outlines);
  const SE3 T_rw = keyframes_[landmark.reference].T_wc.inverse();
  for (const PlaneObservation& o : landmark.observations) {
    f(T_rw * keyframes_[o.keyframe].T_wc, o.outlines);
  }
}

// The plane is better known than what one picture says of it, and a pixel's ray better than its
// depth: so the corners of all pictures are put onto the plane anew.
void Map::update_outline(PlaneId id) {
  std::vector<std::vector<Eigen::Vector3d>> pictures;
  for_each_view(id, [&](const SE3& T_rk, const std::vector<std::vector<Eigen::Vector3d>>& parts) {
    std::vector<Eigen::Vector3d> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    pictures.push_back(outline_on(planes_[id].plane, T_rk, all));
  });
  std::vector<Eigen::Vector3d> outline = common_outline(planes_[id].plane, pictures);
  if (outline.size() > 2) planes_[id].outline = std::move(outline);
}

std::vector<PlaneOutlines> Map::plane_views(PlaneId id) const {
  std::vector<PlaneOutlines> views;
  for_each_view(id, [&](const SE3& T_rk, const std::vector<std::vector<Eigen::Vector3d>>& parts) {
    views.push_back({T_rk, parts});
  });
  return views;
}

MaskedPoints Map::points_in_masks(PlaneId id) const {
  const PlaneLandmark& landmark = planes_[id];
  std::vector<std::pair<PointId, MaskVotes>> votes(points_.slots());  // found faster than in a map
  const auto votes_of = [&](PointId p) -> MaskVotes& {
    votes[p.slot].first = p;
    return votes[p.slot].second;
  };
  for (const auto& [p, buried] : landmark.buried_votes) {
    if (points_.contains(p)) votes_of(p) = buried;
  }
  for (const PlaneObservation& o : landmark.observations) {
    count_votes(keyframes_[o.keyframe], o, votes_of);
  }
  MaskedPoints points;
  for (const auto& [p, v] : votes) {
    const int in = v.inside + v.rim, out = v.beside + v.outside;
    if (2 * v.inside > 3 * out) points.inner.push_back(p);
    if (2 * in > 3 * out) points.all.push_back(p);
    if (2 * (in + v.beside) > 3 * v.outside) points.near.push_back(p);
  }
  return points;
}

void Map::erase_plane(PlaneId id) {
  const std::vector<PointId> members = planes_[id].points;
  for (const PointId point : members) {
    points_[point].plane = {};
    if (points_[point].assumed) erase_point(point);  // nothing else says where it is
  }
  std::erase_if(relations_, [&](const RelatedPlanes& r) { return r.a == id || r.b == id; });
  objects_.for_each([&](ObjectId, ObjectLandmark& object) {
    if (object.support == id) object.support = {};
  });
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
  for (const auto& [label, votes] : moved.votes) target.votes[label] += votes;
  target.sightings = std::max(target.sightings, moved.sightings);  // many of them are the same
  target.last_seen = std::max(target.last_seen, moved.last_seen);
  for (const PlaneObservation& o : moved.observations) target.add(o);
  const SE3 T_rf = keyframes_[target.reference].T_wc.inverse() * keyframes_[moved.reference].T_wc;
  for (const PlaneOutlines& seen : moved.buried_views) {
    bury(target, {T_rf * seen.T_rk, seen.outlines});
  }
  for (const auto& [point, votes] : moved.buried_votes) target.buried_votes[point] += votes;
  update_outline(into);
  for (const PointId point : moved.points) set_plane_of(point, into);
  erase_plane(from);
}

Plane Map::plane_in_world(PlaneId id) const {
  const PlaneLandmark& landmark = planes_[id];
  return landmark.plane.transformed(keyframes_[landmark.reference].T_wc);
}

std::vector<Eigen::Vector3d> Map::outline_in_world(PlaneId id) const {
  const PlaneLandmark& landmark = planes_[id];
  return transformed(landmark.outline, keyframes_[landmark.reference].T_wc);
}

// What the keyframe saw of planes is still true once it is gone: a neighbour takes it over, unless
// it saw the plane itself. Without a neighbour the planes that hang on the keyframe go with it.
void Map::move_planes(KeyframeId from, KeyframeId to) {
  const SE3 T_tf = to.valid() ? keyframes_[to].T_wc.inverse() * keyframes_[from].T_wc : SE3();
  planes_.for_each([&](PlaneId id, PlaneLandmark& landmark) {
    const auto seen = std::find_if(landmark.observations.begin(), landmark.observations.end(),
                                   [&](const PlaneObservation& o) { return o.keyframe == from; });
    if (seen != landmark.observations.end()) {
      PlaneObservation o = std::move(*seen);
      landmark.observations.erase(seen);
      const SE3 T_rw = keyframes_[landmark.reference].T_wc.inverse();
      bury(landmark, {T_rw * keyframes_[from].T_wc, std::move(o.outlines)});
      o.keyframe = to;
      o.normal = T_tf.rotation() * o.normal;
      o.centroid = T_tf * o.centroid;
      std::erase_if(landmark.buried_votes,
                    [&](const auto& v) { return !points_.contains(v.first); });
      count_votes(keyframes_[from], o,
                  [&](PointId p) -> MaskVotes& { return landmark.buried_votes[p]; });
      o.outlines.clear();
      o.keypoints.clear();
      o.inner.clear();
      o.beside.clear();
      if (to.valid()) landmark.add(o);
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
