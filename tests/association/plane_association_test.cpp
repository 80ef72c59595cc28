#include "cairn/association/plane_association.h"

#include <gmock/gmock.h>

#include <numbers>

#include "geometry/planes.h"
#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::disturbed;
using testing::few_poses;
using testing::grid_on;
using testing::indices;
using testing::map_of;
using testing::rectangle;
using testing::seen_from;
using testing::wall_corners;
using Kind = PlaneDecision::Kind;

// A wall of 36 points that the first keyframe saw; the second one looks.
class PlaneAssociation : public ::testing::Test {
 protected:
  PlaneAssociation() : map(map_of(grid_on(wall_corners(), 6), poses)) {
    wall = map.add_plane(map.first(), seen_from(poses[0], wall_corners()));
    for (const PointId p : testing::points_of(map)) map.set_plane_of(p, wall);
  }

  PlaneDecision decide(const SeenPlane& seen) const {
    const std::vector<SeenPlane> planes = {seen};
    return associate_planes(map, map.newest(), planes, {}).at(0);
  }
  static SeenPlane with_keypoints(SeenPlane seen, std::uint32_t number) {
    seen.keypoints = seen.inner = indices(0, number);
    return seen;
  }
  // A part of the same wall that does not touch what was seen of it before.
  SeenPlane elsewhere() const {
    return seen_from(poses[1], rectangle({4.5, -1, 4}, {1, 0, 0}, {0, 2, 0}));
  }
  SeenPlane same_place() const { return seen_from(poses[1], wall_corners()); }

  const std::vector<SE3> poses = few_poses(2);
  Map map;
  PlaneId wall;
};

TEST_F(PlaneAssociation, ManySharedKeypointsMakeItKnown) {
  const PlaneDecision decision = decide(with_keypoints(elsewhere(), 12));
  EXPECT_EQ(decision.kind, Kind::kKnown);
  EXPECT_EQ(decision.plane, wall);
}

TEST_F(PlaneAssociation, FewSharedKeypointsElsewhereMakeItNew) {
  EXPECT_EQ(decide(with_keypoints(elsewhere(), 3)).kind, Kind::kNew);
  EXPECT_EQ(decide(elsewhere()).kind, Kind::kNew);
}

TEST_F(PlaneAssociation, BetweenTheThresholdsNothingIsDecided) {
  for (const std::uint32_t shared : {4u, 11u}) {
    const PlaneDecision decision = decide(with_keypoints(elsewhere(), shared));
    EXPECT_EQ(decision.kind, Kind::kUnclear) << shared;
    EXPECT_FALSE(decision.plane.valid());
  }
}

TEST_F(PlaneAssociation, ItIsNotThePlaneOfItsKeypointsIfTheNormalDisagrees) {
  EXPECT_EQ(decide(with_keypoints(disturbed(same_place(), 10, 0), 36)).kind, Kind::kKnown);
  EXPECT_NE(decide(with_keypoints(disturbed(same_place(), 40, 0), 36)).kind, Kind::kKnown);
}

TEST_F(PlaneAssociation, ItIsNotThePlaneOfItsKeypointsIfTheOffsetDisagrees) {
  EXPECT_EQ(decide(with_keypoints(disturbed(same_place(), 0, -0.05), 36)).kind, Kind::kKnown);
  EXPECT_NE(decide(with_keypoints(disturbed(same_place(), 0, -0.3), 36)).kind, Kind::kKnown);
}

// A box on a table may be just as high as a counter on the other side of the room.
TEST_F(PlaneAssociation, ItIsNotThePlaneOfItsKeypointsIfThatOneIsFarAside) {
  map.erase_plane(wall);
  for (const double gap : {0.5, 3.0}) {
    const auto aside = rectangle({-2 - gap, -1, 4}, {0.5, 0, 0}, {0, 2, 0});
    const PlaneId known = map.add_plane(map.first(), seen_from(poses[0], aside));
    SeenPlane seen = with_keypoints(same_place(), 36);
    seen.sigma_angle = seen.sigma_offset = 1e-6;  // so that the keypoints alone say which it is
    const PlaneDecision decision = decide(disturbed(seen, 1, 0));
    EXPECT_EQ(decision.kind, gap < 1 ? Kind::kKnown : Kind::kNew) << gap;
    map.erase_plane(known);
  }
}

TEST_F(PlaneAssociation, FewKeypointsAtTheSamePlaceMakeItKnown) {
  for (const std::uint32_t shared : {0u, 3u, 8u}) {
    const PlaneDecision decision = decide(with_keypoints(disturbed(same_place(), 5, 0.02), shared));
    EXPECT_EQ(decision.kind, Kind::kKnown) << shared;
    EXPECT_EQ(decision.plane, wall);
  }
}

TEST_F(PlaneAssociation, OfTwoAtThePlaceItIsTheNearerOne) {
  const auto behind = rectangle({-1.5, -1, 4.3}, {3, 0, 0}, {0, 2, 0});
  const PlaneId other = map.add_plane(map.first(), seen_from(poses[0], behind));
  const auto nearer_to = [&](double z) {
    return decide(seen_from(poses[1], rectangle({-1.5, -1, z}, {3, 0, 0}, {0, 2, 0}))).plane;
  };
  EXPECT_EQ(nearer_to(4.05), wall);
  EXPECT_EQ(nearer_to(4.25), other);
}

// All its keypoints are on the wall, which would have to be seen through.
TEST_F(PlaneAssociation, ItIsNotThePlaneThatPicturesShowFromTheOtherSide) {
  SE3& T_wc = map.keyframes()[map.newest()].T_wc;
  T_wc = SE3(so3_exp(Eigen::Vector3d(0, std::numbers::pi, 0)), {0, 0, 8});
  const SeenPlane back = seen_from(T_wc, wall_corners());
  EXPECT_EQ(decide(back).kind, Kind::kNew);
  EXPECT_EQ(decide(with_keypoints(back, 36)).kind, Kind::kNew);
}

TEST_F(PlaneAssociation, WhereNothingIsNearItIsNew) {
  const auto corners = rectangle({-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(decide(seen_from(poses[1], corners)).kind, Kind::kNew);
  map.erase_plane(wall);
  EXPECT_EQ(decide(with_keypoints(same_place(), 36)).kind, Kind::kNew);
}

// A small patch was known; now the whole wall is seen, of which no corner lies on the patch.
TEST_F(PlaneAssociation, ALargePlaneAroundASmallKnownOneIsThatOne) {
  map.erase_plane(wall);
  const auto patch = rectangle({1.2, 0.7, 4}, {0.2, 0, 0}, {0, 0.2, 0});
  const PlaneId small = map.add_plane(map.first(), seen_from(poses[0], patch));
  const auto large = rectangle({-3, -3, 4}, {6, 0, 0}, {0, 6, 0});
  const PlaneDecision decision = decide(seen_from(poses[1], large));
  EXPECT_EQ(decision.kind, Kind::kKnown);
  EXPECT_EQ(decision.plane, small);
}

class OneSurface : public ::testing::Test {
 protected:
  OneSurface() { camera = map.add_keyframe(testing::frame_at({}, 0), SE3()); }
  PlaneId add(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    return map.add_plane(camera, seen_from(SE3(), rectangle(corner, u, v), "table"));
  }
  bool one(PlaneId a, PlaneId b) const {
    EXPECT_EQ(one_surface(map, a, b, 3, {}), one_surface(map, b, a, 3, {}));
    return one_surface(map, a, b, 3, {});
  }

  Map map{testing::point_view()};
  KeyframeId camera;
};

TEST_F(OneSurface, AreTwoHalvesOfATableThatTouch) {
  const PlaneId left = add({-1, 1, 2}, {1, 0, 0}, {0, 0, 2});
  const PlaneId right = add({0, 1.02, 2}, {1, 0, 0}, {0, 0, 2});
  EXPECT_TRUE(one(left, right));
}

TEST_F(OneSurface, AreNotTwoTablesApart) {
  const PlaneId left = add({-2, 1, 2}, {1, 0, 0}, {0, 0, 2});
  const PlaneId right = add({0, 1, 2}, {1, 0, 0}, {0, 0, 2});
  EXPECT_FALSE(one(left, right));
}

TEST_F(OneSurface, AreNotParallelShelves) {
  const PlaneId lower = add({-1, 1, 2}, {2, 0, 0}, {0, 0, 1});
  const PlaneId upper = add({-1, 0.5, 2}, {2, 0, 0}, {0, 0, 1});
  EXPECT_FALSE(one(lower, upper));
}

// The walls of a corridor, should drift bring them together.
TEST_F(OneSurface, AreNotTwoThatFaceEachOther) {
  const auto corners = rectangle({-1, -1, 4}, {2, 0, 0}, {0, 2, 0});
  const SE3 behind(so3_exp(Eigen::Vector3d(0, std::numbers::pi, 0)), {0, 0, 8});
  const KeyframeId other = map.add_keyframe(testing::frame_at({}, 1), behind);
  const PlaneId here = map.add_plane(camera, seen_from(SE3(), corners));
  EXPECT_TRUE(one(here, map.add_plane(camera, seen_from(SE3(), corners))));
  EXPECT_FALSE(one(here, map.add_plane(other, seen_from(behind, corners))));
}

TEST_F(OneSurface, AreNotAWallAndTheFloorThatMeet) {
  const PlaneId floor = add({-1, 1, 2}, {2, 0, 0}, {0, 0, 2});
  const PlaneId wall = add({-1, -1, 4}, {2, 0, 0}, {0, 2, 0});
  EXPECT_FALSE(one(floor, wall));
}

}  // namespace
}  // namespace cairn
