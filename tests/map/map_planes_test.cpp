#include <gmock/gmock.h>

#include "geometry/planes.h"
#include "map/flat_map.h"
#include "map/links.h"

namespace cairn {
namespace {

using testing::broken_links;
using testing::broken_planes;
using ::testing::ElementsAre;
using testing::few_poses;
using testing::grid_on;
using ::testing::IsEmpty;
using testing::IsNearPlane;
using testing::map_of;
using testing::points_of;
using testing::Random;
using testing::rectangle;
using testing::seen_from;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;
using testing::wall_corners;

const Plane kWall(Eigen::Vector3d::UnitZ(), -4);

class MapPlanes : public ::testing::Test {
 protected:
  MapPlanes() : map(map_of(grid_on(wall_corners(), 4), poses)), points(points_of(map)) {
    const auto keyframes = testing::keyframes_of(map);
    a = keyframes[0], b = keyframes[1], c = keyframes[2];
  }

  SeenPlane wall_of(KeyframeId id, const std::string& label = "wall") const {
    return seen_from(map.keyframes()[id].T_wc, wall_corners(), label);
  }

  const std::vector<SE3> poses = few_poses(3);
  Map map;
  std::vector<PointId> points;
  KeyframeId a, b, c;
};

bool has_corner(const std::vector<Eigen::Vector3d>& outline, const Eigen::Vector3d& corner) {
  return std::any_of(outline.begin(), outline.end(),
                     [&](const Eigen::Vector3d& x) { return (x - corner).norm() < 1e-9; });
}

TEST(ConvexOutline, OfASquareWithPointsInsideIsItsFourCorners) {
  Random random(3);
  const Plane plane(Eigen::Vector3d(0.3, -0.5, 0.8).normalized(), -2.5);
  const Eigen::Vector3d n = plane.normal(), foot = -plane.offset() * n;
  const auto axes = tangent_axes(n);
  std::vector<Eigen::Vector3d> points, corners;
  for (int i = 0; i < 4; ++i) {
    const double angle = 0.3 + i * M_PI / 2;
    corners.push_back(foot + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  for (int i = 0; i < 50; ++i) {  // inside, and off the plane
    const double x = random.uniform(-0.4, 0.4), y = random.uniform(-0.4, 0.4);
    points.push_back(foot + axes * Eigen::Vector2d(x, y) + random.uniform(-1, 1) * n);
    if (i % 13 == 0) points.push_back(corners[i / 13]);
  }
  const std::vector<Eigen::Vector3d> outline = convex_outline(plane, points);
  ASSERT_THAT(outline, SizeIs(4));
  for (const Eigen::Vector3d& corner : corners) EXPECT_TRUE(has_corner(outline, corner));
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d edge = outline[(i + 1) % 4] - outline[i];
    const Eigen::Vector3d next = outline[(i + 2) % 4] - outline[(i + 1) % 4];
    EXPECT_GT(edge.cross(next).dot(n), 0) << "clockwise at corner " << i;
  }
}

TEST(ConvexOutline, OfFewPointsIsWhatThereIs) {
  EXPECT_THAT(convex_outline(kWall, {}), IsEmpty());
  std::vector<Eigen::Vector3d> points = {Eigen::Vector3d(1, 2, 4)};
  EXPECT_THAT(convex_outline(kWall, points), SizeIs(1));
  points.emplace_back(0, 2, 4);
  EXPECT_THAT(convex_outline(kWall, points), SizeIs(2));
}

TEST(PlaneLandmark, IsCalledWhatMostVotesSay) {
  PlaneLandmark landmark;
  EXPECT_EQ(landmark.label(), "");
  landmark.votes = {{"table", 0.75}, {"wall", 1.25}};
  EXPECT_EQ(landmark.label(), "wall");
  landmark.votes["table"] += 0.5;
  EXPECT_EQ(landmark.label(), "table") << "of equal ones the first by name";
}

TEST_F(MapPlanes, ANewPlaneIsWhereItsKeyframeSawIt) {
  const PlaneId id = map.add_plane(b, wall_of(b));
  const PlaneLandmark& landmark = map.planes()[id];
  EXPECT_EQ(landmark.reference, b);
  ASSERT_THAT(landmark.observations, SizeIs(1));
  EXPECT_TRUE(landmark.seen_by(b));
  EXPECT_EQ(landmark.sightings, 1u);
  EXPECT_EQ(landmark.last_seen, map.keyframes()[b].sequence);
  EXPECT_GT(landmark.plane.offset(), 0) << "the keyframe is on its positive side";
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall, 1e-6, 1e-9));
  const auto outline = map.outline_in_world(id);
  ASSERT_THAT(outline, SizeIs(4));
  for (const Eigen::Vector3d& corner : wall_corners()) EXPECT_TRUE(has_corner(outline, corner));
}

TEST_F(MapPlanes, AnotherKeyframeAddsItsVotesItsObservationAndItsCorners) {
  const PlaneId id = map.add_plane(a, wall_of(a, "wall"));
  SeenPlane door = seen_from(poses[2], rectangle({1, -1, 4}, {1, 0, 0}, {0, 2, 0}), "door");
  door.score = 1.5;
  map.observe_plane(id, c, door);
  const PlaneLandmark& landmark = map.planes()[id];
  EXPECT_EQ(landmark.label(), "door");
  EXPECT_EQ(landmark.reference, a);
  EXPECT_EQ(landmark.sightings, 2u);
  EXPECT_EQ(landmark.last_seen, map.keyframes()[c].sequence);
  ASSERT_THAT(landmark.observations, SizeIs(2));
  EXPECT_EQ(landmark.observations[1].keyframe, c);
  EXPECT_THAT(Plane::through(landmark.observations[1].centroid, landmark.observations[1].normal)
                  .transformed(poses[2]),
              IsNearPlane(kWall, 1e-6, 1e-9));
  EXPECT_TRUE(has_corner(map.outline_in_world(id), {2, 1, 4}));
}

// Detectors cut one surface into pieces; that makes no more pictures of it.
TEST_F(MapPlanes, TwoPiecesInOnePictureAreOneSightingAndOneObservation) {
  const PlaneId id = map.add_plane(a, wall_of(a));
  map.observe_plane(id, a, wall_of(a));
  EXPECT_THAT(map.planes()[id].observations, SizeIs(1));
  EXPECT_EQ(map.planes()[id].sightings, 1u);
}

TEST_F(MapPlanes, APointLiesOnOnePlaneAtATime) {
  const PlaneId p = map.add_plane(a, wall_of(a)), q = map.add_plane(b, wall_of(b));
  map.set_plane_of(points[0], p);
  map.set_plane_of(points[0], p);
  map.set_plane_of(points[1], p);
  EXPECT_THAT(map.planes()[p].points, ElementsAre(points[0], points[1]));
  map.set_plane_of(points[0], q);
  EXPECT_THAT(map.planes()[p].points, ElementsAre(points[1]));
  EXPECT_THAT(map.planes()[q].points, ElementsAre(points[0]));
  EXPECT_EQ(map.points()[points[0]].plane, q);
  map.set_plane_of(points[0], {});
  EXPECT_THAT(map.planes()[q].points, IsEmpty());
  EXPECT_EQ(broken_planes(map), "");
}

TEST_F(MapPlanes, PointsThatGoLeaveTheirPlane) {
  const PlaneId p = map.add_plane(a, wall_of(a)), q = map.add_plane(b, wall_of(b));
  for (int i : {0, 1, 2}) map.set_plane_of(points[i], p);
  for (int i : {3, 4}) map.set_plane_of(points[i], q);
  map.erase_point(points[0]);
  EXPECT_EQ(broken_planes(map), "");
  map.merge_points(points[1], points[5]);  // into one of no plane: it is on the plane now
  EXPECT_EQ(map.points()[points[5]].plane, p);
  map.merge_points(points[2], points[3]);  // into one of another plane: that stays
  EXPECT_EQ(map.points()[points[3]].plane, q);
  map.merge_points(points[6], points[4]);
  EXPECT_EQ(map.points()[points[4]].plane, q);
  EXPECT_THAT(map.planes()[p].points, ElementsAre(points[5]));
  EXPECT_THAT(map.planes()[q].points, ElementsAre(points[3], points[4]));
  EXPECT_EQ(broken_planes(map), "");
  EXPECT_EQ(broken_links(map), "");
}

TEST_F(MapPlanes, AnErasedPlaneFreesItsPointsAndTakesItsRelationsAlong) {
  const PlaneId p = map.add_plane(a, wall_of(a)), q = map.add_plane(a, wall_of(a)),
                r = map.add_plane(a, wall_of(a));
  map.relations() = {{p, q, PlaneRelation::kParallel}, {p, r}, {q, r}};
  map.set_plane_of(points[0], q);
  map.erase_plane(q);
  EXPECT_FALSE(map.points()[points[0]].plane.valid());
  ASSERT_THAT(map.relations(), SizeIs(1));
  EXPECT_EQ(map.relations()[0].a, p);
  EXPECT_EQ(map.relations()[0].b, r);
  EXPECT_EQ(broken_planes(map), "");
}

TEST_F(MapPlanes, MergedPlanesHaveThePointsVotesObservationsAndCornersOfBoth) {
  const PlaneId into = map.add_plane(a, seen_from(poses[0], wall_corners(), "wall"));
  const PlaneId from =
      map.add_plane(b, seen_from(poses[1], rectangle({1, -1, 4}, {1, 0, 0}, {0, 2, 0}), "door"));
  map.observe_plane(into, c, wall_of(c));
  map.observe_plane(from, c, wall_of(c, "door"));
  map.set_plane_of(points[0], into);
  for (int i : {1, 2, 3}) map.set_plane_of(points[i], from);
  map.merge_planes(from, into);
  EXPECT_FALSE(map.planes().contains(from));
  const PlaneLandmark& landmark = map.planes()[into];
  EXPECT_THAT(landmark.points, UnorderedElementsAre(points[0], points[1], points[2], points[3]));
  EXPECT_EQ(landmark.votes.at("wall"), 2);
  EXPECT_EQ(landmark.votes.at("door"), 2);
  EXPECT_THAT(landmark.observations, SizeIs(3)) << "one a keyframe";
  EXPECT_TRUE(has_corner(map.outline_in_world(into), {2, 1, 4}));
  EXPECT_TRUE(has_corner(map.outline_in_world(into), {-1.5, 1, 4}));
  EXPECT_THAT(map.plane_in_world(into), IsNearPlane(kWall, 1e-6, 1e-9));
  EXPECT_EQ(broken_planes(map), "");
}

TEST(CommonOutline, LeavesOutWhatOnlyOnePictureInManyShows) {
  const auto small = rectangle({-1, -1, 4}, {2, 0, 0}, {0, 2, 0});
  std::vector<std::vector<Eigen::Vector3d>> outlines(30, small);
  outlines.push_back(rectangle({-1, -1, 4}, {9, 0, 0}, {0, 2, 0}));
  const auto outline = common_outline(kWall, outlines);
  ASSERT_THAT(outline, SizeIs(4));
  for (const Eigen::Vector3d& corner : small) EXPECT_TRUE(has_corner(outline, corner));
  outlines.resize(3);  // of few pictures each counts
  outlines.push_back(rectangle({-1, -1, 4}, {9, 0, 0}, {0, 2, 0}));
  EXPECT_TRUE(has_corner(common_outline(kWall, outlines), {8, 1, 4}));
  EXPECT_THAT(common_outline(kWall, {}), IsEmpty());
}

TEST(MovedAlongRays, CornersKeepTheirPixelsAndThoseThatMissThePlaneGo) {
  const std::vector<Eigen::Vector3d> corners = {{1, 1, 2}, {-1, 1, 2}, {-1, -1, 2}, {0, 0, -2}};
  const auto moved = moved_along_rays(corners, kWall);
  ASSERT_THAT(moved, SizeIs(3));
  EXPECT_LT((moved[0] - Eigen::Vector3d(2, 2, 4)).norm(), 1e-9);
  const Plane floor(-Eigen::Vector3d::UnitY(), 1);  // y = 1
  const std::vector<Eigen::Vector3d> low = {{1, 1, 2}, {0, 1, 2}, {-1, 1, 2}, {0, 0.01, 1}};
  EXPECT_THAT(moved_along_rays(low, floor), SizeIs(3)) << "the horizon is far";
}

TEST_F(MapPlanes, APlaneStaysWhereItIsWhenItsReferenceGoes) {
  const PlaneId id = map.add_plane(a, wall_of(a));
  map.observe_plane(id, c, wall_of(c));
  const auto outline = map.outline_in_world(id);
  map.erase_keyframe(a);
  const PlaneLandmark& landmark = map.planes()[id];
  EXPECT_EQ(landmark.reference, b) << "of equal neighbours the oldest";
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall, 1e-6, 1e-9));
  for (const Eigen::Vector3d& corner : map.outline_in_world(id)) {
    EXPECT_TRUE(has_corner(outline, corner));
  }
  ASSERT_THAT(landmark.observations, SizeIs(2));
  for (const PlaneObservation& o : landmark.observations) {
    EXPECT_THAT(Plane::through(o.centroid, o.normal).transformed(map.keyframes()[o.keyframe].T_wc),
                IsNearPlane(kWall, 1e-6, 1e-9));
  }
  EXPECT_TRUE(landmark.seen_by(b));
  EXPECT_EQ(broken_planes(map), "");
  map.erase_keyframe(c);  // b has an observation of its own: c's goes
  EXPECT_THAT(map.planes()[id].observations, SizeIs(1));
  EXPECT_EQ(broken_planes(map), "");
}

TEST_F(MapPlanes, WhatAKeyframeThatIsGoneSawLiesOnThePlaneWhereItIsNow) {
  const PlaneId id = map.add_plane(a, wall_of(a).scaled(1.5));  // as little was known
  map.erase_keyframe(a);
  PlaneLandmark& landmark = map.planes()[id];
  landmark.plane = kWall.transformed(map.keyframes()[landmark.reference].T_wc.inverse());
  map.update_outline(id);
  EXPECT_THAT(map.outline_in_world(id), SizeIs(4));
  for (const Eigen::Vector3d& corner : wall_corners()) {
    EXPECT_TRUE(has_corner(map.outline_in_world(id), corner)) << corner.transpose();
  }
}

TEST(MapPlanesOfLongSequences, KeepSomeOfWhatKeyframesSawThatAreGone) {
  constexpr int kMany = 500;
  Map map = map_of(wall_corners(), std::vector<SE3>(kMany));
  const std::vector<KeyframeId> keyframes = testing::keyframes_of(map);
  const SeenPlane seen = seen_from(SE3(), wall_corners());
  const PlaneId id = map.add_plane(keyframes[0], seen);
  for (int i = 1; i < kMany; ++i) map.observe_plane(id, keyframes[i], seen);
  for (int i = 0; i + 1 < kMany; ++i) map.erase_keyframe(keyframes[i]);
  map.update_outline(id);
  EXPECT_GT(map.plane_views(id).size(), 100);
  EXPECT_LT(map.plane_views(id).size(), 210);
  EXPECT_THAT(map.outline_in_world(id), SizeIs(4));
}

TEST_F(MapPlanes, APlaneGoesWithAReferenceThatHasNoNeighbour) {
  const KeyframeId lonely = map.add_keyframe(testing::frame_at({}, 9), SE3());
  const PlaneId id = map.add_plane(lonely, seen_from(SE3(), wall_corners()));
  map.erase_keyframe(lonely);
  EXPECT_FALSE(map.planes().contains(id));
  EXPECT_EQ(broken_planes(map), "");
}

TEST_F(MapPlanes, APlaneMovesWithItsReferenceAndWithNoOther) {
  const PlaneId id = map.add_plane(a, wall_of(a));
  map.observe_plane(id, b, wall_of(b));
  Random random(4);
  map.keyframes()[b].T_wc = map.keyframes()[b].T_wc * random.motion(0.3, 1);
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall, 1e-6, 1e-9));
  const SE3 moved(so3_exp({0, 0.2, 0}), Eigen::Vector3d(0, 0, 0.5));
  map.keyframes()[a].T_wc = moved;  // it was the world
  EXPECT_THAT(map.plane_in_world(id), IsNearPlane(kWall.transformed(moved), 1e-6, 1e-9));
  EXPECT_TRUE(has_corner(map.outline_in_world(id), moved * wall_corners()[0]));
}

TEST_F(MapPlanes, PointsOfAssumedDepthGoWithTheirPlane) {
  const PlaneId id = map.add_plane(a, wall_of(a));
  map.set_plane_of(points[0], id);
  map.set_plane_of(points[1], id);
  map.points()[points[0]].assumed = true;
  map.erase_plane(id);
  EXPECT_FALSE(map.points().contains(points[0])) << "nothing else says where it is";
  EXPECT_TRUE(map.points().contains(points[1])) << "measured";
  EXPECT_EQ(broken_links(map), "");
}

TEST_F(MapPlanes, AMeasuredPointTakesThePlaceOfAnAssumedOne) {
  const PointId assumed = map.add_point(map.points()[points[0]].position * 1.3);
  map.points()[assumed].assumed = true;
  const Eigen::Vector3d measured = map.points()[points[0]].position;
  map.merge_points(points[0], assumed);
  EXPECT_FALSE(map.points()[assumed].assumed);
  EXPECT_EQ(map.points()[assumed].position, measured);
  EXPECT_EQ(broken_links(map), "");
}

}  // namespace
}  // namespace cairn
