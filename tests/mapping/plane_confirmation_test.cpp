#include "cairn/mapping/plane_confirmation.h"

#include <gmock/gmock.h>

#include <array>
#include <string>

#include "mapping/planes_of_pictures.h"

namespace cairn {
namespace {

using testing::broken_planes;
using ::testing::ElementsAre;
using testing::few_poses;
using testing::grid_on;
using testing::indices;
using testing::IsNearPlane;
using testing::keyframes_of;
using testing::map_of;
using testing::perceive;
using testing::planes_of;
using testing::rectangle;
using testing::seen_from;
using ::testing::SizeIs;
using testing::wall_corners;
using PlaneConfirmation = testing::MapPlanesOfPictures;

// Upright, before a wall and a floor.
TEST_F(PlaneConfirmation, WhatStandsAsItsLabelCannotStaysOutOfTheMap) {
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
      show_picture(id, seen);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(label == "table" ? 2 : 3)) << label;
  }
}

// More pictures show a table over the floor, and call it a wall. Cameras that are never rolled tell
// that it is level, once they have turned.
TEST_F(PlaneConfirmation, ATableThatIsCalledAWallDeniesNoFloor) {
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
      show_picture(id, seen);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(turn > 0.1 ? 2 : 1)) << turn;
  }
}

// No keypoint is on it: with the others well known, many pictures say where it is, unless its masks
// are full of what is elsewhere.
TEST_F(PlaneConfirmation, OfABareCeilingManyPicturesAreEnoughWhereTheWorldIsManhattan) {
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
      show_picture(id, seen);
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

// Six pictures of a wall; what stands out is what each landmark lacks.
TEST_F(PlaneConfirmation, AtTheEndOnlyPlanesStayOfWhichPicturesAndPointsAreSure) {
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
TEST_F(PlaneConfirmation, WhatIsClearlyASurfaceMayBeMissedMoreOften) {
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
TEST_F(PlaneConfirmation, WallsThatLeanStayOutOfTheMap) {
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
      show_picture(id, seen);
    }
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(before)) << label << ", " << manhattan;
    settle_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(finished)) << label << ", " << manhattan;
  }
}

// The camera walks sideways, 0.14 downwards in all.
TEST_F(PlaneConfirmation, NoPictureShowsASurfaceEdgeOn) {
  for (const double below : {0.07, 0.7}) {
    const auto along = rectangle({-0.5, below, 2.5}, {2, 0, 0}, {0, 0, 1.5});
    points = grid_on(along, 6);
    map = map_of(points, few_poses(8));
    for (const KeyframeId id : keyframes_of(map)) show(id, {along});
    remove_unconfirmed_planes(map, options);
    EXPECT_THAT(planes_of(map), SizeIs(below > 0.1 ? 1 : 0)) << below;
  }
}

// Of 36 points half lie before the wall and half behind it.
TEST_F(PlaneConfirmation, InTheFinishedMapSurfacesMustBeFlatter) {
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
