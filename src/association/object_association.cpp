#include "cairn/association/object_association.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cairn/geometry/assignment.h"
#include "cairn/geometry/ellipse_projection.h"
#include "cairn/map/object_classes.h"

namespace cairn {
namespace {

constexpr double kTie = 0.9;        // of one point: what overlap may add where as many points agree
constexpr double kSamePlace = 0.7;  // IoU of a box and a thing of any class that are one
constexpr double kInside = 0.8;     // of a box that shows a part of what the border cuts

// An object in front of the camera, as the camera sees it.
struct Candidate {
  ObjectId id;
  std::string class_name;
  bool born;
  Box2 box;                             // its projection, inside of the picture
  Eigen::Vector2d centre;               // projected
  std::vector<Eigen::Vector2d> points;  // projected
};

std::vector<Candidate> candidates_of(const Map& map, const Keyframe& keyframe) {
  std::vector<Candidate> candidates;
  const SE3 T_cw = keyframe.T_wc.inverse();
  const Pinhole& pinhole = map.view().pinhole();
  map.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    const Ellipsoid in_world = map.object_in_world(id);
    const Ellipsoid in_camera{T_cw * in_world.T, in_world.semi_axes};
    const std::optional<Box2> box = projected_box(pinhole, in_camera);
    if (!box) return;
    Candidate c{id,
                landmark.class_name(),
                landmark.born,
                box->clipped(map.view().borders()),
                pinhole.project(in_camera.centre()),
                {}};
    if (!c.box.valid()) return;
    for (const PointId p : landmark.points) {
      const MapPoint* point = map.points().find(p);
      if (point == nullptr) continue;
      const Eigen::Vector3d X = T_cw * point->position;
      if (X.z() <= 0) continue;
      const Eigen::Vector2d uv = pinhole.project(X);
      if (map.view().contains(uv)) c.points.push_back(uv);
    }
    candidates.push_back(std::move(c));
  });
  return candidates;
}

int points_inside(const Candidate& candidate, const Box2& box) {
  return static_cast<int>(std::count_if(candidate.points.begin(), candidate.points.end(),
                                        [&](const auto& uv) { return box.contains(uv); }));
}

// The centre of a thing that the border cuts is not that of its box.
bool centre_agrees(const Candidate& candidate, const SeenObject& seen, double most) {
  const Eigen::Vector2d off = candidate.centre - seen.box.centre();
  const double reach = most * std::hypot(seen.box.width(), seen.box.height()) / 2;
  const bool beside = seen.cut[0] || seen.cut[2], above = seen.cut[1] || seen.cut[3];
  return (beside || std::abs(off.x()) <= reach) && (above || std::abs(off.y()) <= reach);
}

bool is_inside(const Box2& part, const Box2& whole) {
  const Box2 shared = part.clipped(whole);
  return shared.valid() && shared.area() >= kInside * part.area() && part.area() < whole.area();
}

// Of what goes on beyond the border, detectors box a part now and then.
bool is_part_of(const SeenObject& part, const SeenObject& whole) {
  return may_be_one_class(part.class_name, whole.class_name) && (part.is_cut() || whole.is_cut()) &&
         is_inside(part.box, whole.box);
}

// May a box be of this thing, or of a part of it? Then it begins no other one.
bool may_show(const SeenObject& seen, const Candidate& candidate,
              const ObjectAssociationOptions& options) {
  const double overlap = intersection_over_union(candidate.box, seen.box);
  if (!may_be_one_class(seen.class_name, candidate.class_name)) return overlap >= kSamePlace;
  return overlap >= options.min_overlap || points_inside(candidate, seen.box) >= options.th_low ||
         (candidate.born && seen.is_cut() && is_inside(seen.box, candidate.box));
}

// Pairs that share what `worth` says (0: not a pair), as many and as much as can be.
template <class Worth>
void pair_up(std::vector<ObjectDecision>& decisions, std::vector<bool>& taken,
             const std::vector<Candidate>& candidates, const Worth& worth) {
  std::vector<std::size_t> rows, columns;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    if (decisions[i].kind != ObjectDecision::Kind::kKnown) rows.push_back(i);
  }
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    if (!taken[j]) columns.push_back(j);
  }
  if (rows.empty() || columns.empty()) return;
  Eigen::MatrixXd value(rows.size(), columns.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      value(long(i), long(j)) = worth(rows[i], candidates[columns[j]]);
    }
  }
  const std::vector<int> column_of =
      assign(Eigen::MatrixXd::Constant(value.rows(), value.cols(), value.maxCoeff()) - value);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int j = column_of[i];
    if (j < 0 || !(value(long(i), j) > 0)) continue;
    const std::size_t candidate = columns[std::size_t(j)];
    taken[candidate] = true;
    decisions[rows[i]] = {ObjectDecision::Kind::kKnown, candidates[candidate].id};
  }
}

}  // namespace

std::vector<ObjectDecision> associate_objects(const Map& map, KeyframeId keyframe,
                                              std::span<const SeenObject> seen,
                                              const ObjectAssociationOptions& options) {
  const std::vector<Candidate> candidates = candidates_of(map, map.keyframes()[keyframe]);
  std::vector<ObjectDecision> decisions(seen.size());
  std::vector<bool> taken(candidates.size(), false);
  const auto may_be = [&](const SeenObject& s, const Candidate& c) {
    return may_be_one_class(s.class_name, c.class_name) && centre_agrees(c, s, options.max_centre);
  };
  pair_up(decisions, taken, candidates, [&](std::size_t i, const Candidate& c) {
    const int shared = points_inside(c, seen[i].box);
    if (shared < options.th_high || !may_be(seen[i], c)) return 0.0;
    return shared + kTie * intersection_over_union(c.box, seen[i].box);
  });
  pair_up(decisions, taken, candidates, [&](std::size_t i, const Candidate& c) {
    const double overlap = intersection_over_union(c.box, seen[i].box);
    return overlap >= options.min_overlap && may_be(seen[i], c) ? overlap : 0.0;
  });
  // No two things are in one place: there a class outside of the family is the detector's mistake.
  pair_up(decisions, taken, candidates, [&](std::size_t i, const Candidate& c) {
    const double overlap = intersection_over_union(c.box, seen[i].box);
    return overlap >= kSamePlace ? overlap : 0.0;
  });
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (decisions[i].kind == ObjectDecision::Kind::kKnown) continue;
    const bool unclear =
        std::any_of(candidates.begin(), candidates.end(),
                    [&](const Candidate& c) { return may_show(seen[i], c, options); }) ||
        std::any_of(seen.begin(), seen.end(),
                    [&](const SeenObject& other) { return is_part_of(seen[i], other); });
    if (unclear) decisions[i].kind = ObjectDecision::Kind::kUnclear;
  }
  return decisions;
}

}  // namespace cairn
