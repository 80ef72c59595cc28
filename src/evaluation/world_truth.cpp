#include "cairn/evaluation/world_truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cairn/evaluation/checked_json.h"
#include "cairn/evaluation/outline.h"
#include "cairn/geometry/outline_ellipsoid.h"

namespace cairn {
namespace {

constexpr double kJoint = 0.01;      // metres between planes that are one
constexpr double kSameAngle = 0.01;  // radians

TurnSymmetry read_symmetry(const CheckedJson& value) {
  const std::string name = value.text();
  if (name == "none") return TurnSymmetry::kNone;
  if (name == "half_turn") return TurnSymmetry::kHalfTurn;
  if (name == "quarter_turn") return TurnSymmetry::kQuarterTurn;
  if (name == "any_turn") return TurnSymmetry::kAnyTurn;
  value.refuse("\"" + name + "\" is none of none, half_turn, quarter_turn, any_turn");
}

TrueObject read_object(const CheckedJson& value) {
  TrueObject object;
  object.id = value.at("id").integer();
  object.class_name = value.at("class").text();
  object.ellipsoid = {SE3(value.at("rotation").rotation(), value.at("center").vector3()),
                      value.at("semi_axes").lengths()};
  if (value.has("surface_points")) {
    object.outlines = outline_ellipsoid(value.at("surface_points").points());
  }
  object.symmetry = read_symmetry(value.at("symmetry"));
  object.axis = value.at("axis").unit_vector();
  object.visible_frames = value.at("visible_frames").integer();
  if (value.has("visible_span_deg"))
    object.visible_span_deg = value.at("visible_span_deg").number();
  return object;
}

TruePlane read_plane(const CheckedJson& value) {
  TruePlane plane;
  plane.id = value.at("id").integer();
  plane.label = value.at("label").text();
  plane.normal = value.at("normal").unit_vector();
  plane.d = value.at("d").number();
  plane.parts = {value.at("outline").outline()};
  if (value.has("visible_frames")) plane.visible_frames = value.at("visible_frames").integer();
  return plane;
}

bool touch(const TruePlane& a, const TruePlane& b) {
  for (const auto& part : a.parts) {
    for (const Eigen::Vector3d& corner : part) {
      if (distance_outside(corner, b.parts, b.normal) < kJoint) return true;
    }
  }
  return false;
}

bool one_surface(const TruePlane& a, const TruePlane& b) {
  const auto& corner = b.parts[0][0];
  return a.label == b.label && a.normal.dot(b.normal) > std::cos(kSameAngle) &&
         std::abs(a.normal.dot(corner) + a.d) < kJoint && (touch(a, b) || touch(b, a));
}

// Takes in those that it goes on in. One pass is enough: what one of them goes on in is part of it
// already.
void join(TruePlane plane, std::vector<TruePlane>& planes) {
  std::erase_if(planes, [&](const TruePlane& other) {
    if (!one_surface(other, plane)) return false;
    plane.id = std::min(plane.id, other.id);
    plane.visible_frames = std::max(plane.visible_frames, other.visible_frames);
    plane.parts.insert(plane.parts.end(), other.parts.begin(), other.parts.end());
    return true;
  });
  planes.push_back(std::move(plane));
}

}  // namespace

WorldTruth read_world(const std::filesystem::path& file) {
  const CheckedJson json =
      CheckedJson::read(file, "the ground truth of a world, which `cairn synth` writes");
  if (json.at("format").text() != "cairn world") {
    json.at("format").refuse("is not \"cairn world\"; name a world.json that `cairn synth` wrote");
  }
  if (json.at("version").integer() != 1) {
    json.at("version").refuse("only version 1 is known; render the world again");
  }
  WorldTruth world;
  for (const CheckedJson& value : json.at("objects").list()) {
    world.objects.push_back(read_object(value));
  }
  for (const CheckedJson& value : json.at("planes").list()) {
    join(read_plane(value), world.planes);
  }
  return world;
}

}  // namespace cairn
