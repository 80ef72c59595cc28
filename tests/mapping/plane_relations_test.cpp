#include "cairn/mapping/plane_relations.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "mapping/planes_of_pictures.h"

namespace cairn {
namespace {

using testing::few_poses;
using testing::grid_on;
using testing::keyframes_of;
using testing::map_of;
using testing::perceive;
using testing::planes_of;
using testing::rectangle;
using ::testing::SizeIs;
using testing::wall_corners;
using PlaneRelations = testing::MapPlanesOfPictures;

TEST_F(PlaneRelations, PlanesAreBoundOnlyWhereTheWorldIsManhattan) {
  for (const bool manhattan : {false, true}) {
    options.manhattan = manhattan;
    map = map_of(points, few_poses(6));
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
      show(id, {wall_corners(), floor});
    }
    ASSERT_THAT(planes_of(map), SizeIs(2));
    ASSERT_THAT(map.relations(), SizeIs(manhattan ? 1 : 0));
    if (!manhattan) continue;
    EXPECT_EQ(map.relations()[0].relation, PlaneRelation::kPerpendicular);
  }
}

// 18 degrees from square: too much for geometry alone, as drift may have turned them.
TEST_F(PlaneRelations, LabelsBindWhatDriftHasTurned) {
  const auto ramp = rectangle({-1, 1, 2.7}, {2, 0, 0}, {0, -0.4, 1.2});
  auto all = grid_on(wall_corners(), 6);
  const auto on_ramp = grid_on(ramp, 6);
  all.insert(all.end(), on_ramp.begin(), on_ramp.end());
  options.manhattan = true;
  for (const std::string label : {"shelf", "floor"}) {
    map = map_of(all, few_poses(6));
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(all.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {wall_corners(), ramp}, 36, 5, 0.04);
      seen.planes[0].label = "wall";
      seen.planes[1].label = label;
      show_picture(id, seen);
    }
    ASSERT_THAT(planes_of(map), SizeIs(2));
    EXPECT_THAT(map.relations(), SizeIs(label == "floor" ? 1 : 0)) << label;
  }
}

// 8 degrees from square: what one picture shows is so, what none shows together may have drifted.
TEST_F(PlaneRelations, WallsThatNoPictureShowsTogetherMayBeSquareAcrossDrift) {
  const auto side = rectangle({-1.2, -1, 2.6}, {0, 1.4, 0}, {0.17, 0, 1.2});
  auto all = grid_on(wall_corners(), 6);
  const auto on_side = grid_on(side, 6);
  all.insert(all.end(), on_side.begin(), on_side.end());
  options.manhattan = true;
  for (const bool together : {true, false}) {
    map = map_of(all, few_poses(14));
    bool first = true;
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(all.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {wall_corners(), side}, 36, 1, 0.01);
      for (SeenPlane& plane : seen.planes) plane.label = "wall";
      if (!together) seen.planes.erase(seen.planes.begin() + (first ? 1 : 0));
      first = !first;
      show_picture(id, seen);
    }
    ASSERT_THAT(planes_of(map), SizeIs(2));
    ASSERT_THAT(map.relations(), SizeIs(together ? 0 : 1));
    if (together) continue;
    EXPECT_EQ(map.relations()[0].relation, PlaneRelation::kPerpendicular);
  }
}

// A floor, and one a third higher: a step, or the same one after the scale has drifted.
class FloorsOfTwoScales : public PlaneRelations {
 protected:
  FloorsOfTwoScales() { options.manhattan = true; }
  void begin() {
    auto all = grid_on(floor, 6);
    const auto on_high = grid_on(higher, 6);
    all.insert(all.end(), on_high.begin(), on_high.end());
    map = map_of(all, few_poses(14));
    for (const KeyframeId id : keyframes_of(map)) map.keyframes()[id].depth.assign(all.size(), 1);
  }
  // One picture, of the floor, of that which seems higher, or of both.
  void show_floors(KeyframeId id, bool low, bool high, const std::string& label) {
    KeyframePerception seen = perceive(map, id, {floor, higher}, 36, 1, 0.01);
    for (SeenPlane& plane : seen.planes) plane.label = label;
    if (!high) seen.planes.pop_back();
    if (!low) seen.planes.erase(seen.planes.begin());
    show_picture(id, seen);
  }
  void show_in_turn(const std::string& label) {
    begin();
    bool low = true;
    for (const KeyframeId id : keyframes_of(map)) {
      show_floors(id, low, !low, label);
      low = !low;
    }
  }
  bool bound_as_one() const {
    return std::any_of(map.relations().begin(), map.relations().end(), [](const RelatedPlanes& r) {
      return r.relation == PlaneRelation::kCoplanar;
    });
  }

  const std::vector<Eigen::Vector3d> higher = rectangle({-1, 0.6, 2.7}, {2, 0, 0}, {0, 0, 1.2});
};

TEST_F(FloorsOfTwoScales, AreOneWhereNoPictureShowsBoth) {
  for (const std::string label : {"floor", "table"}) {
    show_in_turn(label);
    ASSERT_THAT(planes_of(map), SizeIs(2));
    EXPECT_EQ(bound_as_one(), label == "floor") << "two tables may be of two heights";
  }
}

TEST_F(FloorsOfTwoScales, AreTwoWherePicturesShowAStepBetweenThem) {
  begin();
  for (const KeyframeId id : keyframes_of(map)) show_floors(id, true, true, "floor");
  ASSERT_THAT(planes_of(map), SizeIs(2));
  EXPECT_FALSE(bound_as_one());
}

TEST_F(FloorsOfTwoScales, AreOneWherePicturesShowThemAsOne) {
  show_in_turn("floor");
  const auto planes = planes_of(map);
  ASSERT_THAT(planes, SizeIs(2));
  map.planes()[planes[1]].observations = map.planes()[planes[0]].observations;
  relate_planes(map, options);
  EXPECT_TRUE(bound_as_one());
}

}  // namespace
}  // namespace cairn
