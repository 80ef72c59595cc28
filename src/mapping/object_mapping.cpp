#include "cairn/mapping/object_mapping.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/triangulation.h"
#include "cairn/map/independent_pictures.h"
#include "cairn/map/object_classes.h"
#include "cairn/mapping/foreign_boxes.h"
#include "cairn/mapping/object_support.h"
#include "cairn/mapping/points_in_box.h"

namespace cairn {
namespace {

constexpr double kOneThing = 0.25;  // IoU of two ellipsoids of one family that are one thing
constexpr double kOnePlace = 0.4;   // the same, of any two: things do not share their place
constexpr double kOneSight = 0.7;   // IoU of a box with what another thing looks like there
constexpr double kUnsure = 3;       // σ of a thing's place, that it may be off
constexpr double kAlike = 0.01;     // radians between two directions that are much the same
constexpr double kNearlyAll = 0.9;  // of the boxes of two guesses, that one thing explains
constexpr double kInside = 1.2;     // level of a point on the thing: boxes are rough
constexpr double kNearer = 0.9, kFarther = 1.5;  // of the distance from which a thing was seen
constexpr double kCovered = 0.3;  // of what is seen where a thing should be, before it
// Detectors see some things in one picture of four, for seconds.
constexpr int kPatience = 3;  // pictures that miss a thing, a picture that shows it

// In the order of Likeness.
constexpr const char* kLikeness[] = {"unlike its class, ", "", "upright, "};

void update_evidence(ObjectLandmark& landmark) {
  std::vector<double> times;
  for (const ObjectObservation& o : landmark.observations) times.push_back(o.time);
  landmark.independent = independent_pictures(std::move(times));
}

// A box that the border cuts on both sides says nothing of where the middle of a thing is.
bool says_where(const SeenObject& thing) {
  return !(thing.cut[0] && thing.cut[2]) && !(thing.cut[1] && thing.cut[3]);
}

// Points of the keyframe that lie on things; those that moved off them go.
void gather_points(Map& map, const Keyframe& keyframe) {
  std::vector<PointId> ids = keyframe.points;
  std::sort(ids.begin(), ids.end());
  std::vector<std::pair<PointId, Eigen::Vector3d>> seen;  // in order, as the points of things are
  for (const PointId p : ids) {
    if (const MapPoint* point = map.points().find(p)) seen.emplace_back(p, point->position);
  }
  map.objects().for_each([&](ObjectId id, ObjectLandmark& landmark) {
    const Ellipsoid in_world = map.object_in_world(id);
    const SE3 T_ew = in_world.T.inverse();
    const double reach = kInside * in_world.semi_axes.maxCoeff();
    const auto inside = [&](const Eigen::Vector3d& X) {
      if ((X - in_world.centre()).squaredNorm() > reach * reach) return false;  // most are not near
      return (T_ew * X).cwiseQuotient(in_world.semi_axes).norm() <= kInside;
    };
    std::vector<PointId>& points = landmark.points;
    std::erase_if(points, [&](PointId p) {
      const MapPoint* point = map.points().find(p);
      return point == nullptr || !inside(point->position);
    });
    const auto known = static_cast<std::ptrdiff_t>(points.size());
    for (const auto& [p, X] : seen) {
      if (inside(X)) points.push_back(p);
    }
    std::inplace_merge(points.begin(), points.begin() + known, points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  });
}

// A guess follows its boxes; once they say enough, it is born.
void bear(Map& map, ObjectLandmark& landmark, const ObjectBirthOptions& options,
          std::map<std::string, int>& refusals) {
  const BoxFit found = fit_to_boxes(map, landmark);
  const ObjectFit& fit = found.fit;
  const std::string reason = refusal(map, landmark, fit, options);
  if (fit.usable) accept(landmark, found);
  if (reason.empty()) {
    landmark.born = true;
    spdlog::debug("object {} is born: {}", landmark.class_name(), fit.to_string());
  } else {
    ++refusals[reason];
    spdlog::debug("object {} is not born: {} ({})", landmark.class_name(), reason, fit.to_string());
  }
}

// Do the middles of two boxes look at one place?
bool look_at_one_place(const Map& map, const ObjectObservation& a, const ObjectObservation& b) {
  const Pinhole& pinhole = map.view().pinhole();
  const SE3 T_ba = map.camera_of(b).inverse() * map.camera_of(a);
  const TwoRayPoint at = triangulate_two_rays(T_ba, pinhole.unproject(a.box.centre()),
                                              pinhole.unproject(b.box.centre()));
  if (at.parallax < kAlike) return true;  // that cannot be told
  return at.in_front() && a.box.contains(pinhole.project(at.point)) &&
         b.box.contains(pinhole.project(T_ba * at.point));
}

// A detector that sees a thing now and then begins a guess of it each time, and none of them has
// the parallax that all have. What could be born of the boxes of two, if it explains nearly all of
// them, is one thing.
void join_guesses(Map& map, ObjectId id, const ObjectBirthOptions& options,
                  std::map<std::string, int>& refusals) {
  const ObjectLandmark& guess = map.objects()[id];
  if (guess.born || guess.observations.size() < 2) return;
  ObjectId found_with;
  map.objects().for_each([&](ObjectId other_id, const ObjectLandmark& other) {
    if (found_with.valid() || other_id == id || other.born || other.last_seen == guess.last_seen ||
        other.observations.size() < 2 ||
        !may_be_one_class(guess.class_name(), other.class_name()) ||
        !look_at_one_place(map, guess.observations.back(), other.observations.back())) {
      return;
    }
    ObjectLandmark both = guess;
    both.take_sightings(other);
    update_evidence(both);
    const ObjectFit fit = fit_to_boxes(map, both).fit;
    if (fit.usable && fit.agreeing >= kNearlyAll * fit.views &&
        refusal(map, both, fit, options).empty()) {
      found_with = other_id;
    }
  });
  if (!found_with.valid()) return;
  spdlog::debug("objects: two guesses of a {} are one thing", guess.class_name());
  map.merge_objects(found_with, id);
  ObjectLandmark& landmark = map.objects()[id];
  update_evidence(landmark);
  bear(map, landmark, options, refusals);
}

// Most boxes of a thing show another one: a detector gives one thing two names in one picture.
bool is_shown_as(const Map& map, const Ellipsoid& other, const ObjectLandmark& thing) {
  const auto shown = std::count_if(
      thing.observations.begin(), thing.observations.end(),
      [&](const ObjectObservation& o) { return box_overlap(map, other, o) > kOneSight; });
  return 2 * shown > std::ssize(thing.observations);
}

bool is_surer(const ObjectLandmark& a, const ObjectLandmark& b) {
  return a.born != b.born ? a.born : a.sightings >= b.sightings;
}

double place_sigma(const ObjectLandmark& landmark) {
  return std::sqrt(landmark.covariance.trace());
}

bool are_one(const Map& map, const ObjectLandmark& a, const Ellipsoid& ea, const ObjectLandmark& b,
             const Ellipsoid& eb) {
  if (!a.born && !b.born) return false;  // two guesses: too little is known of either
  const double apart = (ea.centre() - eb.centre()).norm();
  const double reach = ea.semi_axes.maxCoeff() + eb.semi_axes.maxCoeff();
  const double unsure = std::max(place_sigma(a), place_sigma(b));
  if (apart > reach + kUnsure * unsure) return false;  // most are
  if (apart <= reach) {
    const bool within = ea.contains(eb.centre()) && eb.contains(ea.centre());
    const bool kin = may_be_one_class(a.class_name(), b.class_name());
    if (within && kin) return true;
    const double least = kin ? kOneThing : kOnePlace;
    if ((within || kin) && intersection_over_union(ea, eb) > least) return true;
  }
  return is_surer(a, b) ? is_shown_as(map, ea, b) : is_shown_as(map, eb, a);
}

void fuse_objects(Map& map) {
  std::vector<std::pair<ObjectId, Ellipsoid>> all;
  map.objects().for_each(
      [&](ObjectId id, const ObjectLandmark&) { all.emplace_back(id, map.object_in_world(id)); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const ObjectLandmark *a = map.objects().find(all[i].first),
                           *b = map.objects().find(all[k].first);
      if (a == nullptr || b == nullptr) continue;
      if (!are_one(map, *a, all[i].second, *b, all[k].second)) continue;
      const bool first = is_surer(*a, *b);
      spdlog::debug("objects: {} and {} are one thing", a->class_name(), b->class_name());
      auto& [kept, in_world] = all[first ? i : k];
      map.merge_objects(all[first ? k : i].first, kept);
      ObjectLandmark& whole = map.objects()[kept];
      update_evidence(whole);
      if (const BoxFit found = fit_to_boxes(map, whole); found.fit.usable) accept(whole, found);
      in_world = map.object_in_world(kept);
    }
  }
}

// Is it wholly in the picture, about as far away as it was seen from, and nothing before it?
bool should_be_seen(const Map& map, const Keyframe& keyframe, ObjectId id) {
  const ObjectLandmark& landmark = map.objects()[id];
  const Ellipsoid in_world = map.object_in_world(id);
  const SE3 T_cw = keyframe.T_wc.inverse();
  const auto box = projected_box(map.view().pinhole(), {T_cw * in_world.T, in_world.semi_axes});
  if (!box || !map.view().contains({box->x0, box->y0}) ||
      !map.view().contains({box->x1, box->y1})) {
    return false;
  }
  const double distance = (T_cw * in_world.centre()).norm();
  double nearest = 1e300, farthest = 0;
  for (const ObjectObservation& o : landmark.observations) {
    const double d = (map.camera_of(o).translation() - in_world.centre()).norm();
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  if (distance < kNearer * nearest || distance > kFarther * farthest) return false;
  int seen = 0, before = 0;
  const double front = distance - in_world.semi_axes.maxCoeff();
  for_each_point_in(*box, map, keyframe, [&](const MapPoint& point) {
    ++seen;
    before += (T_cw * point.position).norm() < front;
  });
  return before <= kCovered * seen;
}

bool is_given_up(const ObjectLandmark& landmark, const ObjectMappingOptions& options) {
  return landmark.missed > std::max(options.max_missed, kPatience * int(landmark.sightings));
}

void let_die(Map& map, KeyframeId id, const ObjectMappingOptions& options) {
  const Keyframe& keyframe = map.keyframes()[id];
  map.objects().for_each([&](ObjectId object, ObjectLandmark& landmark) {
    if (landmark.observations.empty()) return map.erase_object(object);
    if (!landmark.born) {
      if (keyframe.timestamp() - landmark.last_time > options.probation) map.erase_object(object);
      return;
    }
    if (landmark.last_seen == keyframe.sequence || !should_be_seen(map, keyframe, object)) return;
    ++landmark.missed;
    if (!is_given_up(landmark, options)) return;
    spdlog::debug("object {} dies: {} pictures should have shown it", landmark.class_name(),
                  landmark.missed);
    map.erase_object(object);
  });
}

// How many of the boxes that objects are made of are of the thing that most of them are of, where a
// simulator says which is which.
void log_identities(const Map& map) {
  int agreeing = 0, all = 0;
  map.objects().for_each([&](ObjectId, const ObjectLandmark& landmark) {
    int most = 0;
    for (const auto& [thing, times] : landmark.things) {
      most = std::max(most, times);
      all += times;
    }
    agreeing += most;
  });
  if (all > 0) spdlog::info("objects: {} of {} boxes are of one thing", agreeing, all);
}

}  // namespace

void map_objects(Map& map, KeyframeId id, const KeyframePerception& seen,
                 const ObjectMappingOptions& options, std::map<std::string, int>& refusals) {
  const Keyframe& keyframe = map.keyframes()[id];
  gather_points(map, keyframe);
  const std::vector<ObjectDecision> decisions =
      associate_objects(map, id, seen.objects, options.association);
  std::vector<ObjectId> known;
  for (std::size_t i = 0; i < seen.objects.size(); ++i) {
    const SeenObject& thing = seen.objects[i];
    if (decisions[i].kind == ObjectDecision::Kind::kUnclear) continue;
    if (decisions[i].kind == ObjectDecision::Kind::kNew) {
      if (says_where(thing)) map.add_object(id, thing, guess_ellipsoid(map, keyframe, thing));
      continue;
    }
    ObjectLandmark& landmark = map.objects()[decisions[i].object];
    map.observe_object(decisions[i].object, id, thing);
    update_evidence(landmark);
    if (!landmark.born) bear(map, landmark, options.birth, refusals);
    known.push_back(decisions[i].object);
  }
  // Not before all have been seen: what one picture shows twice is two things, of which none must
  // go while its box waits.
  for (const ObjectId object : known) join_guesses(map, object, options.birth, refusals);
  fuse_objects(map);
  let_die(map, id, options);
  if (options.supports) {
    find_supports(map, map.units_a_true_metre(), options.max_gap, 2 * options.max_gap);
  }
}

void settle_objects(Map& map, const ObjectMappingOptions& options) {
  drop_foreign_boxes(map);
  map.objects().for_each([&](ObjectId, ObjectLandmark& landmark) {
    if (const BoxFit found = fit_to_boxes(map, landmark); found.fit.usable) accept(landmark, found);
  });
  drop_foreign_boxes(map);  // most boxes decide what a fit shows, and the others stand out
  map.objects().for_each([&](ObjectId id, ObjectLandmark& landmark) {
    if (landmark.observations.empty()) return map.erase_object(id);
    update_evidence(landmark);
    const BoxFit found = fit_to_boxes(map, landmark);
    const ObjectFit& fit = found.fit;
    const std::string reason = refusal(map, landmark, fit, options.birth);
    if (fit.usable) accept(landmark, found);
    landmark.confirmed = landmark.born && reason.empty() && fit.agreeing >= options.min_sightings &&
                         !is_given_up(landmark, options);
    spdlog::debug(
        "object {}: {} pictures, {} missed, {}: {}", landmark.class_name(), landmark.sightings,
        landmark.missed, fit.to_string(),
        kLikeness[int(found.likeness)] + (landmark.confirmed ? "kept" : "refused: " + reason));
    if (!landmark.confirmed) map.erase_object(id);
  });
  fuse_objects(map);
  log_identities(map);
}

}  // namespace cairn
