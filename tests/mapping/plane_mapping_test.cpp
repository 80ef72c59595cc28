#include "cairn/mapping/plane_mapping.h"

#include <gmock/gmock.h>

#include <array>

#include "geometry/planes.h"
#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::broken_planes;
using testing::disturbed;
using ::testing::ElementsAre;
using testing::few_poses;
using testing::grid_on;
using testing::indices;
using testing::IsNearPlane;
using testing::keyframes_of;
using testing::map_of;
using testing::planes_of;
using testing::rectangle;
using testing::seen_from;
using ::testing::SizeIs;
using testing::wall_corners;

const Plane kWall(Eigen::Vector3d::UnitZ(), -4);
constexpr double kScale = 2;  // units of the map a metre of the detector

SeenPlane in_metres(SeenPlane seen) {
  seen.plane = seen.plane.scaled(1 / kScale);
  seen.centroid /= kScale;
  seen.sigma_offset /= kScale;
  for (Eigen::Vector3d& corner : seen.outline) corner /= kScale;
  return seen;
}

// Planes by corners (world), disturbed, with so many keypoints each, one after the other.
KeyframePerception perceive(const Map& map, KeyframeId id,
                            const std::vector<std::vector<Eigen::Vector3d>>& planes,
                            std::uint32_t keypoints, double angle_deg, double share) {
  const Keyframe& keyframe = map.keyframes()[id];
  KeyframePerception perception;
  perception.frame = keyframe.frame;
  perception.depth.assign(keyframe.frame->size(), 0);
  for (const auto& corners : planes) {
    SeenPlane seen = disturbed(seen_from(keyframe.T_wc, corners), angle_deg, share);
    seen.keypoints =
        indices(static_cast<std::uint32_t>(perception.planes.size()) * keypoints, keypoints);
    seen.inner = seen.keypoints;
    seen.sigma_angle = 0.1;
    seen.sigma_offset = 0.2;
    perception.planes.push_back(in_metres(seen));
  }
  return perception;
}

class MapPlanesOfPictures : public ::testing::Test {
 protected:
  // 36 points of a wall, 36 of the floor before it, 6 in front of the wall.
  MapPlanesOfPictures() {
    points = grid_on(wall_corners(), 6);
    const auto on_floor = grid_on(floor, 6);
    points.insert(points.end(), on_floor.begin(), on_floor.end());
    for (int i = 0; i < 6; ++i) points.emplace_back(0.2 * i - 0.5, 0.1 * i - 0.2, 3);
    map = map_of(points, few_poses(3));
  }
  void show(KeyframeId id, const std::vector<std::vector<Eigen::Vector3d>>& planes) {
    map_planes(map, id, perceive(map, id, planes, 36, 5, 0.04), {kScale, kScale, 0.04, 0}, options);
    EXPECT_EQ(broken_planes(map), "");
  }

  const std::vector<Eigen::Vector3d> floor = rectangle({-1, 1, 2.7}, {2, 0, 0}, {0, 0, 1.2});
  std::vector<Eigen::Vector3d> points;
  Map map{testing::point_view()};
  PlaneMappingOptions options;
};

TEST_F(MapPlanesOfPictures, OnePlaneInTwoPicturesIsOneLandmarkWithItsPoints) {
  const auto keyframes = keyframes_of(map);
  for (int i : {0, 1}) {
    KeyframePerception seen = perceive(map, keyframes[i], {wall_corners()}, 36, 5, 0.04);
    for (std::uint32_t k = 72; k < 78; ++k) {  // in front
      seen.planes[0].keypoints.push_back(k);
      seen.planes[0].inner.push_back(k);
    }
    map_planes(map, keyframes[i], seen, {kScale, kScale, 0.04, 0}, options);
  }
  ASSERT_THAT(planes_of(map), SizeIs(1));
  const PlaneId id = planes_of(map)[0];
  const PlaneLandmark& landmark = map.planes()[id];
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall, 1, 0.04)) << "as the points say";
  EXPECT_THAT(landmark.points, SizeIs(36)) << "all of the wall, none in front of it";
  EXPECT_EQ(landmark.sightings, 2u);
  ASSERT_THAT(landmark.observations, SizeIs(2));
  for (const PlaneObservation& o : landmark.observations) {  // as the pictures say
    const SE3& T_wc = map.keyframes()[o.keyframe].T_wc;
    const SeenPlane said = disturbed(seen_from(T_wc, wall_corners()), 5, 0.04);
    EXPECT_LT((o.centroid - said.centroid).norm(), 1e-9);
    EXPECT_THAT(Plane::through(o.centroid, o.normal), IsNearPlane(said.plane, 1e-3, 1e-6));
  }
  EXPECT_EQ(broken_planes(map), "");
}

// A keyframe that has lost half of its points: on the wall, and in front of it.
TEST_F(MapPlanesOfPictures, WhereMeasuredPointsAreFewPlaneAndPredictedDepthGiveThem) {
  const KeyframeId keyframe = keyframes_of(map)[1];
  KeyframePerception seen = perceive(map, keyframe, {wall_corners()}, 36, 0, 0);
  const SE3 T_cw = map.keyframes()[keyframe].T_wc.inverse();
  std::vector<std::uint32_t> freed;
  for (std::uint32_t k = 0; k < 78; k += 2) {
    if (k >= 36 && k < 72) continue;  // the floor stays
    const PointId p = map.keyframes()[keyframe].points[k];
    const double z = (T_cw * map.points()[p].position).z();
    seen.depth[k] = k < 36 ? 0 : float(z / kScale);  // beside the wall, the network says
    map.erase_point(p);
    freed.push_back(k);
  }
  options.few_points = 10;  // more are measured: nothing is assumed
  EXPECT_TRUE(map_planes(map, keyframe, seen, {kScale, kScale, 0.04, 0}, options).empty());
  options.few_points = 100;
  const auto assumed = map_planes(map, keyframe, seen, {kScale, kScale, 0.04, 0}, options);
  EXPECT_EQ(assumed.size(), freed.size());
  for (const PointId p : assumed) {
    const MapPoint& point = map.points()[p];
    EXPECT_TRUE(point.assumed);
    const std::uint32_t k = point.observations.front().keypoint;
    EXPECT_LT((point.position - points[k]).norm(), 0.05) << k;
    EXPECT_EQ(point.plane.valid(), k < 36) << k;
  }
  EXPECT_EQ(broken_planes(map), "");
}

TEST_F(MapPlanesOfPictures, PlanesAreBoundOnlyWhereTheWorldIsManhattan) {
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
TEST_F(MapPlanesOfPictures, LabelsBindWhatDriftHasTurned) {
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
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    ASSERT_THAT(planes_of(map), SizeIs(2));
    EXPECT_THAT(map.relations(), SizeIs(label == "floor" ? 1 : 0)) << label;
  }
}

// Upright, before a wall and a floor.
TEST_F(MapPlanesOfPictures, WhatStandsAsItsLabelCannotStaysOutOfTheMap) {
  const auto board = rectangle({-0.8, -0.8, 2.9}, {1.2, 0, 0}, {0, 1.2, 0});
  const auto on_board = grid_on(board, 6);
  points.resize(72);
  points.insert(points.end(), on_board.begin(), on_board.end());
  for (const std::string label : {"cabinet", "wall", "table"}) {
    map = map_of(points, few_poses(6));
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {wall_corners(), floor, board}, 36, 5, 0.04);
      const std::array<std::string, 3> labels = {"wall", "floor", label};
      for (std::size_t i : {0, 1, 2}) seen.planes[i].label = labels[i];
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(label == "table" ? 2 : 3)) << label;
  }
}

// More pictures show a table over the floor, and call it a wall. Cameras that are never rolled tell
// that it is level, once they have turned.
TEST_F(MapPlanesOfPictures, ATableThatIsCalledAWallDeniesNoFloor) {
  const auto table = rectangle({-0.6, 0.5, 2.6}, {1.2, 0, 0}, {0, 0, 0.9});
  std::vector<Eigen::Vector3d> all = grid_on(table, 6);
  const auto on_floor = grid_on(floor, 6);
  all.insert(all.end(), on_floor.begin(), on_floor.end());
  for (const double turn : {0.02, 0.16}) {
    std::vector<SE3> poses = few_poses(8);
    for (int i = 0; i < 8; ++i) {
      poses[i] = SE3(so3_exp(Eigen::Vector3d(0, i % 2 ? turn : -turn, 0)), poses[i].translation());
    }
    map = map_of(all, poses);
    int pictures = 0;
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(all.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {table, floor}, 36, 5, 0.04);
      seen.planes[0].label = "wall";
      seen.planes[1].label = "floor";
      if (++pictures <= 2) seen.planes.pop_back();
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(turn > 0.1 ? 2 : 1)) << turn;
  }
}

// 8 degrees from square: what one picture shows is so, what none shows together may have drifted.
TEST_F(MapPlanesOfPictures, WallsThatNoPictureShowsTogetherMayBeSquareAcrossDrift) {
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
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    ASSERT_THAT(planes_of(map), SizeIs(2));
    ASSERT_THAT(map.relations(), SizeIs(together ? 0 : 1));
    if (together) continue;
    EXPECT_EQ(map.relations()[0].relation, PlaneRelation::kPerpendicular);
  }
}

// No keypoint is on it: with the others well known, many pictures say where it is, unless its masks
// are full of what is elsewhere.
TEST_F(MapPlanesOfPictures, OfABareCeilingManyPicturesAreEnoughWhereTheWorldIsManhattan) {
  const auto ceiling = rectangle({-1, -1, 2.7}, {2, 0, 0}, {0, 0, 1.2});
  struct Case {
    bool manhattan;
    int pictures;
    std::uint32_t others;  // points in its masks
    bool known;
  };
  for (const auto& [manhattan, pictures, others, known] : {Case{true, 12, 0, true},
                                                           {true, 3, 0, false},
                                                           {false, 12, 0, false},
                                                           {true, 12, 6, false}}) {
    options.manhattan = manhattan;
    map = map_of(points, few_poses(12));
    int shown = 0;
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {wall_corners(), floor, ceiling}, 36, 1, 0.02);
      const std::array<std::string, 3> labels = {"wall", "floor", "ceiling"};
      for (std::size_t i : {0, 1, 2}) seen.planes[i].label = labels[i];
      seen.planes[2].keypoints = seen.planes[2].inner = indices(72, others);
      if (++shown > pictures) seen.planes.pop_back();
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    remove_unconfirmed_planes(map, options);
    ASSERT_THAT(planes_of(map), SizeIs(known ? 3 : 2))
        << manhattan << ", " << pictures << ", " << others;
    if (!known) continue;
    const Plane truth = Plane::through({0, -1, 3}, Eigen::Vector3d::UnitY());
    EXPECT_THAT(map.plane_in_world(planes_of(map)[2]), IsNearPlane(truth, 2, 0.05));
    EXPECT_EQ(broken_planes(map), "");
  }
}

// What 0.3 units are from far away says nothing of shelves that are near.
TEST_F(MapPlanesOfPictures, ShelvesStayTwoWhenAFarWallIsInThePicture) {
  const KeyframeId id = map.first();
  map.add_plane(id, seen_from(SE3(), rectangle({-0.5, 0.3, 1}, {1, 0, 0}, {0, 0, 0.5})));
  map.add_plane(id, seen_from(SE3(), rectangle({-0.5, 0.6, 1}, {1, 0, 0}, {0, 0, 0.5})));
  show(id, {wall_corners()});
  EXPECT_THAT(planes_of(map), SizeIs(3));
}

// Six pictures of a wall; what stands out is what each landmark lacks.
TEST_F(MapPlanesOfPictures, AtTheEndOnlyPlanesStayOfWhichPicturesAndPointsAreSure) {
  const auto add = [&](int sightings, const std::vector<std::uint32_t>& keypoints) {
    const auto keyframes = keyframes_of(map);
    PlaneId id;
    for (int i = 0; i < sightings; ++i) {
      SeenPlane wall = seen_from(few_poses(6)[i], wall_corners());
      wall.sigma_angle = 0.2;
      wall.sigma_offset = 0.1;
      wall.keypoints = wall.inner = keypoints;
      if (i == 0) id = map.add_plane(keyframes[i], wall);
      if (i > 0) map.observe_plane(id, keyframes[i], wall);
    }
    return id;
  };
  for (int i = 0; i < 6; ++i) points.emplace_back(0.2 * i - 0.5, 0.1 * i - 0.2, 5);
  map = map_of(points, few_poses(6));
  for (const KeyframeId id : keyframes_of(map)) {
    map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
  }
  const PlaneId sure = add(6, {0, 1, 4, 5, 30, 31, 34, 35});
  add(6, {2, 3, 32, 33});                                  // few points
  add(4, {6, 7, 10, 11, 24, 25, 28, 29});                  // few pictures
  add(6, {12, 13, 14, 15, 16, 17});                        // on a line
  add(6, {8, 9, 26, 27, 20, 21, 78, 79, 80, 81, 82, 83});  // half of them behind it
  remove_unconfirmed_planes(map, options);
  EXPECT_THAT(planes_of(map), ElementsAre(sure));
  EXPECT_EQ(broken_planes(map), "");
}

// Half of the pictures that show its points miss it. Every fourth point is off a surface, or none.
TEST_F(MapPlanesOfPictures, WhatIsClearlyASurfaceMayBeMissedMoreOften) {
  for (const int off : {0, 4}) {
    points = grid_on(wall_corners(), 6);
    for (std::size_t i = 0; off > 0 && i < points.size(); i += off) points[i].z() += 0.4;
    map = map_of(points, few_poses(15));
    int pictures = 0;
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
      if (++pictures > 6) show(id, {});
      if (pictures <= 6) show(id, {wall_corners()});
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(off == 0 ? 1 : 0)) << off;
  }
}

// It leans by 18 degrees over a floor that more pictures show. Relations might set it right.
TEST_F(MapPlanesOfPictures, WallsThatLeanStayOutOfTheMap) {
  const auto leaning = rectangle({-1, -1, 2.7}, {2, 0, 0}, {0, 1.2, 0.4});
  points = grid_on(leaning, 6);
  const auto on_floor = grid_on(floor, 6);
  points.insert(points.end(), on_floor.begin(), on_floor.end());
  struct Case {
    std::string label;
    bool manhattan;
    std::size_t before, finished;  // planes, before and after the full adjustment
  };
  for (const auto& [label, manhattan, before, finished] :
       {Case{"cabinet", false, 2, 2}, {"wall", false, 1, 1}, {"wall", true, 2, 1}}) {
    options.manhattan = manhattan;
    map = map_of(points, few_poses(10));
    int pictures = 0;
    for (const KeyframeId id : keyframes_of(map)) {
      map.keyframes()[id].depth.assign(points.size(), 1);  // looked at
      KeyframePerception seen = perceive(map, id, {leaning, floor}, 36, 5, 0.04);
      seen.planes[0].label = label;
      seen.planes[1].label = "floor";
      if (++pictures <= 3) seen.planes.erase(seen.planes.begin());
      map_planes(map, id, seen, {kScale, kScale, 0.04, 0}, options);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(before)) << label << ", " << manhattan;
    settle_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(finished)) << label << ", " << manhattan;
  }
}

// The camera walks from 0 to 2.1.
TEST_F(MapPlanesOfPictures, NoPictureShowsASurfaceEdgeOn) {
  for (const double aside : {1.0, -1.5}) {
    const auto along = rectangle({aside, -0.5, 2.5}, {0, 1, 0}, {0, 0, 2});
    points = grid_on(along, 6);
    map = map_of(points, few_poses(8));
    for (const KeyframeId id : keyframes_of(map)) show(id, {along});
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(aside < 0 ? 1 : 0)) << aside;
  }
}

// Of 36 points half lie before the wall and half behind it.
TEST_F(MapPlanesOfPictures, InTheFinishedMapSurfacesMustBeFlatter) {
  for (const double spread : {0.007, 0.013}) {
    points = grid_on(wall_corners(), 6);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] *= 1 + (i % 2 == i / 6 % 2 ? 1 : -1) * spread / 1.48;
    }
    map = map_of(points, few_poses(6));
    for (const KeyframeId id : keyframes_of(map)) show(id, {wall_corners()});
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(1)) << spread;
    settle_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(spread < 0.01 ? 1 : 0)) << spread;
  }
}

}  // namespace
}  // namespace cairn
