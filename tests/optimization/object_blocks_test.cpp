#include "cairn/optimization/object_blocks.h"

#include <gtest/gtest.h>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/optimization/map_adjustment.h"
#include "map/flat_map.h"
#include "map/links.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::few_poses;
using testing::kCamera;
using testing::keyframes_of;
using testing::points_of;
using testing::Random;

constexpr int kPoses = 6;
constexpr std::size_t kOnWall = 60;

// On the wall z = 4, and before it.
Map points_map() {
  Random random(41);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < 200; ++i) {
    const double x = random.uniform(-1.5, 1.5), y = random.uniform(-1, 1);
    points.emplace_back(x, y, i < kOnWall ? 4 : random.uniform(2.5, 4));
  }
  return testing::map_of(points, few_poses(kPoses), 0.2, 42);
}

Ellipsoid moved(const SE3& T, const Ellipsoid& e) { return {T * e.T, e.semi_axes}; }

Ellipsoid thing(const Vector3d& centre) {
  return {SE3(so3_exp(Vector3d(0.3, 0.2, 0.1)), centre), Vector3d(0.24, 0.17, 0.2)};
}

// Relative to the first keyframe and seen by all, without error.
ObjectId add_object(Map& map, const Ellipsoid& in_world) {
  ObjectLandmark landmark;
  landmark.reference = map.first();
  landmark.ellipsoid = moved(map.keyframes()[map.first()].T_wc.inverse(), in_world);
  landmark.votes["thing"] = 1;
  landmark.born = true;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    const auto box = projected_box(kCamera, moved(keyframe.T_wc.inverse(), in_world));
    ASSERT_TRUE(box.has_value());
    landmark.observations.push_back({id, *box, {}, 2, 1});
  });
  landmark.independent = double(landmark.observations.size());
  return map.objects().insert(landmark);
}

Ellipsoid in_world(const Map& map, ObjectId id) {
  const ObjectLandmark& landmark = map.objects()[id];
  return moved(map.keyframes()[landmark.reference].T_wc, landmark.ellipsoid);
}

void displace(Map& map, ObjectId id) {
  Ellipsoid& e = map.objects()[id].ellipsoid;
  e.T = SE3(e.T.rotation() * so3_exp(Vector3d(0.1, -0.2, 0.1)),
            e.T.translation() + Vector3d(0.06, -0.06, 0.12));
  e.semi_axes *= 1.3;
}

std::vector<double> numbers_of(const Map& map) {
  std::vector<double> numbers;
  const auto write = [&](const auto& m) {
    numbers.insert(numbers.end(), m.data(), m.data() + m.size());
  };
  map.keyframes().for_each([&](KeyframeId, const Keyframe& k) {
    write(k.T_wc.rotation().coeffs());
    write(k.T_wc.translation());
  });
  map.points().for_each([&](PointId, const MapPoint& p) { write(p.position); });
  map.objects().for_each([&](ObjectId, const ObjectLandmark& o) {
    write(o.ellipsoid.T.rotation().coeffs());
    write(o.ellipsoid.T.translation());
    write(o.ellipsoid.semi_axes);
  });
  return numbers;
}

TEST(ObjectsInAnAdjustment, ComeToTheirBoxesInAFullOneAndInALocalOne) {
  for (const bool full : {true, false}) {
    Map map = points_map();
    const Ellipsoid truth = thing({0.3, 0.1, 3});
    const ObjectId id = add_object(map, truth);
    displace(map, id);
    const double before = intersection_over_union(in_world(map, id), truth);
    AdjustmentOptions options;
    options.local_iterations = 40;
    options.window = options.fixed = 2;  // two keyframes of six are outside, the reference perhaps
    ASSERT_TRUE((full ? adjust_fully(map, options, nullptr)
                      : adjust_locally(map, map.newest(), options, nullptr))
                    .usable);
    const Ellipsoid found = in_world(map, id);
    EXPECT_LT((found.centre() - truth.centre()).norm(), 0.06) << full;
    EXPECT_GT(intersection_over_union(found, truth), std::max(before, 0.7)) << full;
    EXPECT_EQ(testing::broken_links(map), "");
  }
}

TEST(ObjectsInAnAdjustment, ComeToTheirBoxesInThePaperFormToo) {
  Map map = points_map();
  const Ellipsoid truth = thing({0.3, 0.1, 3});
  const ObjectId id = add_object(map, truth);
  displace(map, id);
  const double before = intersection_over_union(in_world(map, id), truth);
  AdjustmentOptions options;
  options.objects.observation.form = options.objects.size.form = FactorForm::kPaper;
  ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
  EXPECT_GT(intersection_over_union(in_world(map, id), truth), before);
}

TEST(ObjectsInAnAdjustment, AreHeldToTheSizeOfTheirClassUnlessTheirBoxesDenyIt) {
  const Ellipsoid truth = thing({0.3, 0.1, 3});
  const auto size_as = [&](Likeness likeness) {
    Map map = points_map();
    map.units_a_metre = 1;
    const ObjectId id = add_object(map, truth);
    map.objects()[id].votes = {{"cell phone", 1}};
    map.objects()[id].likeness = likeness;
    EXPECT_TRUE(adjust_fully(map, {}, nullptr).usable);
    return std::cbrt(in_world(map, id).semi_axes.prod());
  };
  const double size = std::cbrt(truth.semi_axes.prod());
  EXPECT_LT(size_as(Likeness::kSize), 0.95 * size);
  EXPECT_GT(size_as(Likeness::kNothing), 0.98 * size);
}

// A keyframe that sees no points but four things.
TEST(ObjectsInAnAdjustment, PullADisplacedCamera) {
  for (const bool objects : {false, true}) {
    Map map = points_map();
    for (const Vector3d& centre : {Vector3d(-0.5, -0.5, 3), Vector3d(0.6, -0.5, 3.5),
                                   Vector3d(-0.5, 0.4, 3.2), Vector3d(0.6, 0.5, 2.8)}) {
      add_object(map, thing(centre));
    }
    const KeyframeId lost = keyframes_of(map)[3];
    for (const PointId p : points_of(map)) map.erase_observation(p, lost);
    Keyframe& keyframe = map.keyframes()[lost];
    const SE3 truth = keyframe.T_wc;
    keyframe.T_wc = truth * SE3(so3_exp(Vector3d(0, 0.03, 0)), Vector3d(0, 0.08, 0));
    AdjustmentOptions options;
    options.objects.observation.use = objects;
    ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
    const double error = (truth.inverse() * map.keyframes()[lost].T_wc).log().norm();
    if (objects) {
      EXPECT_LT(error, 0.02);
    } else {
      EXPECT_GT(error, 0.06);
    }
  }
}

// What its boxes do not show (how it is turned around the line of sight, how deep it is) must not
// run away while the points move the cameras.
TEST(ObjectsInAnAdjustment, StayInTheirBoxesHoweverOftenTheMapIsAdjusted) {
  Random random(43);
  Map map = points_map();
  const Ellipsoid keyboard{SE3(so3_exp(Vector3d(0.2, 0.3, 0)), {0.1, 0.2, 2.5}),
                           Vector3d(0.3, 0.03, 0.1)};
  const ObjectId id = add_object(map, keyboard);
  ObjectLandmark& landmark = map.objects()[id];
  landmark.independent = 1.5;  // all pictures of a moment
  for (ObjectObservation& o : landmark.observations) {
    o.box.x0 += 2 * random.gaussian();
    o.box.y1 += 2 * random.gaussian();
  }
  for (int round = 0; round < 10; ++round) {
    map.points().for_each([&](PointId, MapPoint& p) { p.position += 0.02 * random.gaussian3(); });
    adjust_locally(map, map.newest(), {}, nullptr);
    const Ellipsoid now = in_world(map, id);
    map.keyframes().for_each([&](KeyframeId k, const Keyframe& keyframe) {
      const auto box = projected_box(kCamera, moved(keyframe.T_wc.inverse(), now));
      ASSERT_TRUE(box.has_value());
      for (const ObjectObservation& o : landmark.observations) {
        if (o.keyframe != k) continue;
        EXPECT_GT(intersection_over_union(*box, o.box), 0.5) << round;
      }
    });
  }
}

TEST(ObjectsInAnAdjustment, ThatAreNotBornOrSeenOnceTakeNoPart) {
  Map without = points_map();
  ASSERT_TRUE(adjust_fully(without, {}, nullptr).usable);
  for (const bool born : {false, true}) {
    Map map = points_map();
    const ObjectId id = add_object(map, thing({0.3, 0.1, 3}));
    displace(map, id);
    ObjectLandmark& landmark = map.objects()[id];
    landmark.born = born;
    if (born) landmark.observations.resize(1);
    const Ellipsoid before = landmark.ellipsoid;
    ASSERT_TRUE(adjust_fully(map, {}, nullptr).usable);
    EXPECT_EQ((landmark.ellipsoid.T.matrix() - before.T.matrix()).norm(), 0);
    EXPECT_EQ((landmark.ellipsoid.semi_axes - before.semi_axes).norm(), 0);
    map.objects().erase(id);
    EXPECT_EQ(numbers_of(map), numbers_of(without));
  }
}

// Boxes that are unsure show it a little before the wall on which it is.
TEST(ObjectsInAnAdjustment, AreDrawnToThePlaneThatTheyStandOn) {
  const Plane wall(Vector3d::UnitZ(), -4);
  double gaps[2] = {};
  for (const bool support : {false, true}) {
    Map map = points_map();
    const std::vector<SE3> poses = few_poses(kPoses);
    const PlaneId plane =
        map.add_plane(map.first(), testing::seen_from(poses[0], testing::wall_corners()));
    const auto keyframes = keyframes_of(map);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      map.observe_plane(plane, keyframes[i], testing::seen_from(poses[i], testing::wall_corners()));
    }
    for (std::size_t i = 0; i < kOnWall; ++i) map.set_plane_of(points_of(map)[i], plane);
    map.planes()[plane].confirmed = true;
    map.planes()[plane].spread = 0.01;
    map.units_a_metre = 1;
    const auto reach = [&](const Ellipsoid& e) {
      return e.semi_axes.cwiseProduct(e.T.rotation().conjugate() * wall.normal()).norm();
    };
    const ObjectId id =
        add_object(map, thing({0.3, 0.1, 4 - 0.06 - reach(thing(Vector3d::Zero()))}));
    map.objects()[id].support = plane;
    AdjustmentOptions options;
    options.objects.observation.sigma = 10;
    options.objects.support.sigma = 0.02;
    options.objects.support.use = support;
    ASSERT_TRUE(adjust_fully(map, options, nullptr).usable);
    const Ellipsoid found = in_world(map, id);
    gaps[support] = std::abs(wall.signed_distance(found.centre())) - reach(found);
  }
  EXPECT_GT(gaps[0], 0.025);
  EXPECT_LT(std::abs(gaps[1]), 0.6 * gaps[0]);
}

TEST(ObjectsInAnAdjustment, SameMapSameBytes) {
  const auto run = [] {
    Map map = points_map();
    for (const double x : {-0.4, 0.5}) displace(map, add_object(map, thing({x, 0.1, 3})));
    adjust_locally(map, map.newest(), {}, nullptr);
    adjust_fully(map, {}, nullptr);
    return numbers_of(map);
  };
  EXPECT_EQ(run(), run());
}

TEST(ObjectBlocks, FollowTheUnitOfTheMap) {
  Map map = points_map();
  const ObjectId id = add_object(map, thing({0.3, 0.1, 3}));
  const Ellipsoid before = map.objects()[id].ellipsoid;
  ObjectBlocks objects(map, {});
  PlaneBlocks planes(map, {});
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(options);
  ceres::ParameterBlockOrdering ordering;
  std::vector<std::array<double, 7>> values(kPoses);
  PoseBlocks poses(map, problem, ordering, [&](KeyframeId k) { return values[k.slot].data(); });
  objects.add_to(problem, ordering, poses, planes);
  EXPECT_EQ(problem.NumResidualBlocks(), kPoses + 2) << "boxes, turn and size";
  objects.scale(2.5);
  objects.write_back(map);
  const Ellipsoid& after = map.objects()[id].ellipsoid;
  EXPECT_LT((after.centre() - 2.5 * before.centre()).norm(), 1e-9);
  EXPECT_LT((after.semi_axes - 2.5 * before.semi_axes).norm(), 1e-9);
  EXPECT_NEAR(after.T.rotation().angularDistance(before.T.rotation()), 0, 1e-7);
}

}  // namespace
}  // namespace cairn
