#include "cairn/evaluation/world_truth.h"

#include "cairn/evaluation/checked_json.h"
#include "cairn/geometry/outline_ellipsoid.h"

namespace cairn {
namespace {

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
  return object;
}

TruePlane read_plane(const CheckedJson& value) {
  TruePlane plane;
  plane.id = value.at("id").integer();
  plane.label = value.at("label").text();
  plane.normal = value.at("normal").unit_vector();
  plane.d = value.at("d").number();
  plane.outline = value.at("outline").outline();
  if (value.has("visible_frames")) plane.visible_frames = value.at("visible_frames").integer();
  return plane;
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
    world.planes.push_back(read_plane(value));
  }
  return world;
}

}  // namespace cairn
