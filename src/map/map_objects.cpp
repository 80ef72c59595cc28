// The objects of the map.

#include <algorithm>

#include "cairn/map/map.h"

namespace cairn {

ObjectId Map::add_object(KeyframeId keyframe, const SeenObject& seen, const Ellipsoid& guess) {
  ObjectLandmark landmark;
  landmark.reference = keyframe;
  landmark.ellipsoid = guess;
  const ObjectId id = objects_.insert(std::move(landmark));
  observe_object(id, keyframe, seen);
  return id;
}

void Map::observe_object(ObjectId id, KeyframeId keyframe, const SeenObject& seen) {
  ObjectLandmark& landmark = objects_[id];
  const Keyframe& k = keyframes_[keyframe];
  landmark.votes[seen.class_name] += seen.score;
  if (seen.thing) ++landmark.things[*seen.thing];
  landmark.sightings += landmark.sightings == 0 || k.sequence != landmark.last_seen;
  landmark.last_seen = k.sequence;
  landmark.last_time = std::max(landmark.last_time, k.timestamp());
  landmark.missed = std::max(landmark.missed - 1, 0);
  if (landmark.seen_by(keyframe)) return;
  landmark.observe({keyframe, seen.box, seen.cut, seen.sigma, seen.score, k.timestamp()});
}

void Map::merge_objects(ObjectId from, ObjectId into) {
  objects_[into].take_sightings(objects_[from]);
  erase_object(from);
}

void Map::erase_object(ObjectId id) { objects_.erase(id); }

Ellipsoid Map::object_in_world(ObjectId id) const {
  const ObjectLandmark& landmark = objects_[id];
  return {keyframes_[landmark.reference].T_wc * landmark.ellipsoid.T, landmark.ellipsoid.semi_axes};
}

void Map::set_object_in_world(ObjectId id, const Ellipsoid& ellipsoid) {
  ObjectLandmark& landmark = objects_[id];
  landmark.ellipsoid = {keyframes_[landmark.reference].T_wc.inverse() * ellipsoid.T,
                        ellipsoid.semi_axes};
}

SE3 Map::camera_of(const ObjectObservation& o) const {
  return keyframes_[o.keyframe].T_wc * o.T_kc;
}

// The lens bends little along an edge, and a thing touches an edge near its middle.
void Map::set_lens(const LensCorrection& lens) {
  if (lens.values == lens_.values) return;
  const Pinhole& pinhole = view_.pinhole();
  const auto moved = [&](double x, double y) {
    return lens.ideal(pinhole, lens_.project(pinhole, pinhole.unproject({x, y})));
  };
  objects_.for_each([&](ObjectId, ObjectLandmark& landmark) {
    for (ObjectObservation& o : landmark.observations) {
      const double x = o.box.centre().x(), y = o.box.centre().y();
      o.box = {moved(o.box.x0, y).x(), moved(x, o.box.y0).y(), moved(o.box.x1, y).x(),
               moved(x, o.box.y1).y()};
    }
  });
  lens_ = lens;
}

// What the keyframe saw is still true once it is gone: its boxes, and what was relative to it, hang
// on a neighbour from now on. Without one they go with it.
void Map::move_objects(KeyframeId from, KeyframeId to) {
  const SE3 T_tf = to.valid() ? keyframes_[to].T_wc.inverse() * keyframes_[from].T_wc : SE3();
  objects_.for_each([&](ObjectId id, ObjectLandmark& landmark) {
    for (ObjectObservation& o : landmark.observations) {
      if (o.keyframe != from) continue;
      o.T_kc = T_tf * o.T_kc;
      o.keyframe = to;
      o.buried = true;
    }
    if (!to.valid()) {
      std::erase_if(landmark.observations,
                    [&](const ObjectObservation& o) { return o.keyframe == to; });
    }
    if (landmark.reference != from) return;
    if (!to.valid()) {
      erase_object(id);
      return;
    }
    landmark.reference = to;
    landmark.ellipsoid.T = T_tf * landmark.ellipsoid.T;
    landmark.covariance = T_tf.matrix3() * landmark.covariance * T_tf.matrix3().transpose();
  });
}

}  // namespace cairn
