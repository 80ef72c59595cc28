#include "cairn/optimization/plane_blocks.h"

#include <gmock/gmock.h>

#include "cairn/optimization/map_adjustment.h"
#include "geometry/planes.h"
#include "map/flat_map.h"
#include "map/links.h"

namespace cairn {
namespace {

using testing::broken_links;
using testing::broken_planes;
using testing::disturbed;
using testing::few_poses;
using testing::IsNearPlane;
using testing::keyframes_of;
using testing::map_of;
using testing::points_of;
using testing::Random;
using testing::rectangle;
using testing::seen_from;
using testing::wall_corners;

const Plane kWall(Eigen::Vector3d::UnitZ(), -4);
constexpr std::size_t kOnWall = 150;

// Points on the wall z = 4, then others before it.
std::vector<Eigen::Vector3d> some_points() {
  Random random(21);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < kOnWall + 80; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-0.7, 0.7);
    const double z = i < kOnWall ? 4 : random.uniform(2.5, 4);
    points.emplace_back(x * z / 4 * 1.5, y * z / 4 * 1.5, z);
  }
  return points;
}

// A map with errors: in depth of the points, in rotation of the keyframes, and in the plane.
Map wall_map() {
  const std::vector<SE3> poses = few_poses(4);
  Map map = map_of(some_points(), poses, 0.5, 22);
  const PlaneId wall = map.add_plane(map.first(), seen_from(poses[0], wall_corners()));
  const auto keyframes = keyframes_of(map);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    map.observe_plane(wall, keyframes[i], seen_from(poses[i], wall_corners()));
  }
  const auto ids = points_of(map);
  for (std::size_t i = 0; i < kOnWall; ++i) map.set_plane_of(ids[i], wall);
  map.planes()[wall].confirmed = true;
  map.planes()[wall].roughness = 0.003;
  map.planes()[wall].plane = disturbed(seen_from(poses[0], wall_corners()), 5, 0.03).plane;
  Random random(23);
  for (const PointId id : ids) map.points()[id].position *= 1 + 0.02 * random.gaussian();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    map.keyframes()[keyframes[i]].T_wc = poses[i] * random.motion(0.01, 0);
  }
  return map;
}

double camera_error(const Map& map) {
  const auto keyframes = keyframes_of(map);
  const std::vector<SE3> poses = few_poses(static_cast<int>(keyframes.size()));
  double worst = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SE3 off = poses[i].inverse() * map.keyframes()[keyframes[i]].T_wc;
    worst = std::max(worst, off.log().norm());
  }
  return worst;
}

AdjustmentOptions without_planes() {
  AdjustmentOptions options;
  options.planes.observation.use = options.planes.point_on_plane.use = false;
  options.planes.parallel.use = options.planes.perpendicular.use = false;
  return options;
}

TEST(PlanesInAnAdjustment, ComeToTheTruthAndDoNotWorsenThePoses) {
  Map with = wall_map(), without = wall_map();
  const PlaneId wall = testing::planes_of(with).at(0);
  const double before = angle_between(with.plane_in_world(wall), kWall);
  ASSERT_TRUE(adjust_fully(with, {}, nullptr).usable);
  ASSERT_TRUE(adjust_fully(without, without_planes(), nullptr).usable);
  EXPECT_LT(angle_between(with.plane_in_world(wall), kWall), 0.2 * before);
  EXPECT_THAT(with.plane_in_world(wall), IsNearPlane(kWall, 0.6, 0.04));
  EXPECT_LT(camera_error(with), 0.02);
  EXPECT_LT(camera_error(with), camera_error(without) + 0.003);
  EXPECT_EQ(broken_links(with), "");
  EXPECT_EQ(broken_planes(with), "");
}

// How far the first points of the wall lie off it after an adjustment (RMS), where so many are
// known to be on it.
double off_the_wall(std::size_t known) {
  Map map = wall_map();
  const PlaneId wall = testing::planes_of(map).at(0);
  const auto ids = points_of(map);
  for (std::size_t i = known; i < kOnWall; ++i) map.set_plane_of(ids[i], {});
  EXPECT_TRUE(adjust_fully(map, {}, nullptr).usable);
  double sum = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    const double d = map.plane_in_world(wall).signed_distance(map.points()[ids[i]].position);
    sum += d * d / 20;
  }
  return std::sqrt(sum);
}

TEST(PlanesInAnAdjustment, ManyPointsSayHowFlatASurfaceIs) {
  EXPECT_LT(off_the_wall(kOnWall), 0.9 * off_the_wall(20));
}

TEST(PlanesInAnAdjustment, OfPointsAloneOrOfObservationsAloneComeToTheTruth) {
  for (const bool by_points : {true, false}) {
    Map map = wall_map();
    AdjustmentOptions options;
    options.planes.point_on_plane.use = by_points;
    options.planes.observation.use = !by_points;
    ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
    EXPECT_THAT(map.plane_in_world(testing::planes_of(map).at(0)), IsNearPlane(kWall, 0.8, 0.05))
        << (by_points ? "points" : "observations");
  }
}

TEST(PlanesInAnAdjustment, ComeToTheTruthInALocalOneThatHoldsTheirReference) {
  Map map = wall_map();
  AdjustmentOptions options;
  options.window = 2;
  const SE3 first = map.keyframes()[map.first()].T_wc;
  const auto keyframes = keyframes_of(map);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    map.keyframes()[keyframes[i]].T_wc = few_poses(4)[i];
  }
  options.local_iterations = 30;
  ASSERT_TRUE(adjust_locally(map, map.newest(), options, nullptr).usable);
  EXPECT_EQ((map.keyframes()[map.first()].T_wc.matrix() - first.matrix()).norm(), 0);
  EXPECT_THAT(map.plane_in_world(testing::planes_of(map).at(0)), IsNearPlane(kWall, 0.8, 0.05));
}

TEST(PlanesInAnAdjustment, DoNotMoveWhereAllTheirFactorsAreOff) {
  for (const bool relations : {false, true}) {
    Map map = wall_map();
    const PlaneId wall = testing::planes_of(map).at(0);
    const PlaneId other = map.add_plane(map.first(), seen_from(SE3(), wall_corners()));
    map.relations().push_back({wall, other, PlaneRelation::kParallel});
    AdjustmentOptions options = without_planes();
    options.planes.parallel.use = relations;  // which hold on to nothing
    const Eigen::Vector4d before = map.planes()[wall].plane.coefficients();
    ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
    EXPECT_EQ((map.planes()[wall].plane.coefficients() - before).norm(), 0);
  }
}

// A patch of the wall that one picture shows nearer than it is.
TEST(PlanesInAnAdjustment, AreBroughtTogetherIfTheyAreOne) {
  const auto corners = rectangle({0.5, -0.5, 4}, {1, 0, 0}, {0, 1, 0});
  for (const bool other_keyframe : {false, true}) {
    for (const bool use : {false, true}) {
      const std::vector<SE3> poses = few_poses(3);
      Map map = map_of(some_points(), poses, 0.3, 31);
      const auto keyframes = keyframes_of(map);
      const std::size_t k = other_keyframe ? 1 : 0;
      const PlaneId a = map.add_plane(keyframes[0], seen_from(poses[0], wall_corners()));
      const PlaneId b =
          map.add_plane(keyframes[k], disturbed(seen_from(poses[k], corners), 0, 0.1));
      map.planes()[a].sigma_tilt = 0.02;
      map.relations() = {{a, b, PlaneRelation::kParallel}, {a, b, PlaneRelation::kCoplanar}};
      AdjustmentOptions options;
      options.planes.observation.sigma = 5;  // what pictures say of distances is unsure
      options.planes.coplanar.use = use;
      ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
      const double apart =
          std::abs(map.plane_in_world(a).offset() - map.plane_in_world(b).offset());
      if (use) {
        EXPECT_LT(apart, 0.06) << other_keyframe;
      } else {
        EXPECT_GT(apart, 0.2) << other_keyframe;
      }
    }
  }
}

// Two patches that pictures show tilted to each other, relative to one keyframe or to two.
class RelatedPatches : public ::testing::TestWithParam<bool> {
 protected:
  // Angle between the two after an adjustment, degrees.
  double adjusted_angle(const std::vector<Eigen::Vector3d>& corners, double tilt_deg,
                        PlaneRelation relation, bool use) const {
    const std::vector<SE3> poses = few_poses(3);
    Map map = map_of(some_points(), poses, 0.3, 31);
    const auto keyframes = keyframes_of(map);
    const std::size_t k = GetParam() ? 1 : 0;
    const PlaneId a = map.add_plane(keyframes[0], seen_from(poses[0], wall_corners()));
    const PlaneId b =
        map.add_plane(keyframes[k], disturbed(seen_from(poses[k], corners), tilt_deg, 0));
    map.relations().push_back({a, b, relation});
    AdjustmentOptions options;
    options.planes.parallel.sigma = options.planes.perpendicular.sigma = 0.2;
    options.planes.parallel.use = options.planes.perpendicular.use = use;
    EXPECT_TRUE(adjust_fully(map, options, nullptr).usable);
    EXPECT_LT(camera_error(map), 0.02);
    return angle_between(map.plane_in_world(a), map.plane_in_world(b)) * 180 / M_PI;
  }
};

TEST_P(RelatedPatches, BecomeParallelIfTheyAreBoundSo) {
  const auto corners = rectangle({0.5, -0.5, 3}, {1, 0, 0}, {0, 1, 0});
  EXPECT_GT(adjusted_angle(corners, 4, PlaneRelation::kParallel, false), 3);
  EXPECT_LT(adjusted_angle(corners, 4, PlaneRelation::kParallel, true), 0.3);
}

TEST_P(RelatedPatches, BecomePerpendicularIfTheyAreBoundSo) {
  const auto corners = rectangle({-1, 1, 2.5}, {2, 0, 0}, {0, 0, 1.5});
  const double tilted = adjusted_angle(corners, 6, PlaneRelation::kPerpendicular, false);
  ASSERT_GT(std::abs(tilted - 90), 1);
  EXPECT_NEAR(adjusted_angle(corners, 6, PlaneRelation::kPerpendicular, true), 90, 0.3);
}

INSTANTIATE_TEST_SUITE_P(OfOneKeyframeAndOfTwo, RelatedPatches, ::testing::Bool());

}  // namespace
}  // namespace cairn
