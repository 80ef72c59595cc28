#include "cairn/tracking/object_relocalization.h"

#include <gtest/gtest.h>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/map/object_classes.h"
#include "cairn/tracking/relocalizer.h"
#include "map/point_world.h"
#include "map/things.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

constexpr double kNoise = 1.5;  // pixels, of an edge

// Stands on the plane z = 0 of a world with z up.
KnownObject standing(const std::string& class_name, double x, double y, double turn) {
  const ObjectClass& c = *find_object_class(class_name);
  const Eigen::Vector3d semi_axes(c.semi_axes[0], c.semi_axes[2], c.semi_axes[1]);
  return {{SE3(so3_exp(Eigen::Vector3d(0, 0, turn)), {x, y, semi_axes.z()}), semi_axes},
          class_name};
}

// Things of mixed classes, some of one family, on a table of 1.6 by 1.2 metres.
std::vector<KnownObject> table(Random& random, std::size_t count) {
  const std::vector<std::string> classes = {"cup",      "bottle", "bowl",       "book",  "laptop",
                                            "keyboard", "vase",   "teddy bear", "clock", "banana"};
  std::vector<KnownObject> things;
  for (int draw = 0; draw < 10000 && things.size() < count; ++draw) {
    const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.6, 0.6);
    const bool free = std::none_of(things.begin(), things.end(), [&](const KnownObject& other) {
      return std::hypot(other.ellipsoid.centre().x() - x, other.ellipsoid.centre().y() - y) < 0.28;
    });
    if (!free) continue;
    const std::string& name = classes[random.below(static_cast<int>(classes.size()))];
    things.push_back(standing(name, x, y, random.uniform(0, M_PI)));
  }
  return things;
}

SE3 looking(const Eigen::Vector3d& from, const Eigen::Vector3d& at, double roll) {
  const Eigen::Vector3d z = (at - from).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return SE3(R, from) * SE3(so3_exp(Eigen::Vector3d(0, 0, roll)), Eigen::Vector3d::Zero());
}

// From any side, looking down at the table.
SE3 somewhere(Random& random) {
  const double turn = random.uniform(-M_PI, M_PI), rise = random.uniform(0.45, 1.05);
  const Eigen::Vector3d at(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.1);
  const Eigen::Vector3d arm(std::cos(rise) * std::cos(turn), std::cos(rise) * std::sin(turn),
                            std::sin(rise));
  const double distance = random.uniform(1.9, 2.6);
  return looking(at + distance * arm, at, random.uniform(-0.3, 0.3));
}

// What a detector says of things before a camera at T_wc, as the border cuts them.
std::vector<SeenObject> see(const std::vector<KnownObject>& things, const SE3& T_wc,
                            Random& random) {
  const View& view = testing::point_view();
  const SE3 T_cw = T_wc.inverse();
  std::vector<SeenObject> seen;
  for (std::size_t k = 0; k < things.size(); ++k) {
    const Ellipsoid& e = things[k].ellipsoid;
    const auto box = projected_box(kCamera, {T_cw * e.T, e.semi_axes});
    if (!box || !view.contains(box->centre())) continue;
    SeenObject s;
    s.cut = {
        box->x0<view.min_x(), box->y0<view.min_y(), box->x1> view.max_x(), box->y1> view.max_y()};
    double noise[4];
    for (double& n : noise) n = kNoise * random.gaussian();
    s.box = Box2{box->x0 + noise[0], box->y0 + noise[1], box->x1 + noise[2], box->y1 + noise[3]}
                .clipped({view.min_x(), view.min_y(), view.max_x(), view.max_y()});
    s.class_name = things[k].class_name;
    s.score = random.uniform(0.5, 1);
    s.thing = static_cast<int>(k);
    seen.push_back(s);
  }
  return seen;
}

int whole(const std::vector<SeenObject>& seen) {
  return static_cast<int>(std::count_if(seen.begin(), seen.end(), [](const SeenObject& s) {
    return std::none_of(s.cut.begin(), s.cut.end(), [](bool c) { return c; });
  }));
}

// Boxes of nothing, of classes that there are.
void add_false_ones(std::vector<SeenObject>& seen, int count, Random& random) {
  const std::size_t real = seen.size();
  for (int i = 0; i < count; ++i) {
    SeenObject s = seen[random.below(static_cast<int>(real))];
    const double x = random.uniform(20, 500), y = random.uniform(20, 350);
    s.box = {x, y, x + random.uniform(30, 110), y + random.uniform(30, 110)};
    s.cut = {};
    s.score = random.uniform(0.5, 1);
    s.thing.reset();
    seen.insert(seen.begin() + random.below(static_cast<int>(seen.size())), s);
  }
}

double share_of_distance(const SE3& T_wc, const SE3& truth) {
  return (T_wc.translation() - truth.translation()).norm() / truth.translation().norm();
}

struct Tally {
  int trials = 0, close = 0, wrong = 0, mistaken = 0;
};

Tally find_cameras(std::uint64_t seed, int false_ones) {
  Random random(seed);
  Tally tally;
  while (tally.trials < 30) {
    const std::vector<KnownObject> things = table(random, 5 + random.below(4));
    const SE3 T_wc = somewhere(random);
    std::vector<SeenObject> seen = see(things, T_wc, random);
    if (whole(seen) < 4) continue;
    add_false_ones(seen, false_ones, random);
    ++tally.trials;
    const auto found = relocalize_by_objects(seen, things, testing::point_view());
    if (!found) continue;
    const double turned = testing::rotation_error_deg(found->T_cw.inverse(), T_wc);
    const double moved = share_of_distance(found->T_cw.inverse(), T_wc);
    tally.close += turned < 3 && moved < 0.05;
    tally.wrong += turned > 15 || moved > 0.2;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (found->thing[i] < 0 || !seen[i].thing) continue;
      tally.mistaken += found->thing[i] != *seen[i].thing;
    }
  }
  return tally;
}

TEST(ObjectRelocalization, FindsACameraOnAnySideOfTheThings) {
  const Tally tally = find_cameras(61, 0);
  EXPECT_GE(tally.close, 27);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(tally.mistaken, 3);
}

TEST(ObjectRelocalization, IsNotMisledByDetectionsOfNothing) {
  const Tally tally = find_cameras(62, 3);
  EXPECT_GE(tally.close, 26);
  EXPECT_EQ(tally.wrong, 0);
}

class KnownTable : public ::testing::Test {
 protected:
  std::optional<ObjectRelocalization> find(const std::vector<SeenObject>& seen,
                                           const std::vector<KnownObject>& known) const {
    return relocalize_by_objects(seen, known, testing::point_view());
  }

  Random random{63};
  std::vector<KnownObject> things = {
      standing("cup", 0.1, 0.3, 0.2),     standing("bottle", -0.5, 0.2, 0),
      standing("laptop", 0.1, -0.2, 0.4), standing("book", 0.5, 0.1, 1.2),
      standing("clock", -0.3, -0.4, 0.8), standing("teddy bear", -0.2, 0.5, 2)};
  SE3 T_wc = looking({1.3, -1.2, 1.5}, {0, 0, 0.1}, 0.1);
  std::vector<SeenObject> seen = see(things, T_wc, random);
};

TEST_F(KnownTable, SaysWhatItSaw) {
  const auto found = find(seen, things);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->certain);
  EXPECT_EQ(found->agreeing, 6);
  EXPECT_GT(found->overlap, 6 * 0.75);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(found->thing[i], *seen[i].thing);
  EXPECT_LT(testing::rotation_error_deg(found->T_cw.inverse(), T_wc), 2);
  const auto again = find(seen, things);
  ASSERT_TRUE(again);
  EXPECT_EQ((found->T_cw.matrix() - again->T_cw.matrix()).norm(), 0);
}

TEST_F(KnownTable, TakesOneClassOfAFamilyForAnother) {
  for (SeenObject& s : seen) {
    if (s.class_name == "cup") s.class_name = "bowl";
    if (s.class_name == "laptop") s.class_name = "tv";
  }
  const auto found = find(seen, things);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->agreeing, 6);
}

TEST_F(KnownTable, IsUnsureBetweenTwoPlacesThatLookAlike) {
  std::vector<KnownObject> twice = things;
  for (KnownObject copy : things) {
    copy.ellipsoid.T =
        SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(60, 0, 0)) * copy.ellipsoid.T;
    twice.push_back(copy);
  }
  EXPECT_FALSE(find(seen, twice));
}

TEST_F(KnownTable, NeedsThreeThings) {
  const std::vector<SeenObject> two(seen.begin(), seen.begin() + 2);
  EXPECT_FALSE(find(two, things));
  EXPECT_FALSE(find(seen, {things.begin(), things.begin() + 2}));
  EXPECT_FALSE(find({}, things));
  EXPECT_FALSE(find(seen, {}));
}

TEST_F(KnownTable, NeedsMostOfWhatShouldBeInThePicture) {
  const std::vector<SeenObject> few(seen.begin(), seen.begin() + 3);
  EXPECT_FALSE(find(few, things)) << "half is not most";
  const std::vector<SeenObject> most(seen.begin(), seen.begin() + 4);
  EXPECT_TRUE(find(most, things));
}

TEST_F(KnownTable, FindsNothingWhereTheClassesAreWrong) {
  std::vector<SeenObject> foreign = seen;
  for (SeenObject& s : foreign) s.class_name = "airplane";
  EXPECT_FALSE(find(foreign, things));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    foreign[i].class_name = seen[(i + 1) % seen.size()].class_name;
  }
  const auto found = find(foreign, things);
  EXPECT_FALSE(found && found->certain);
}

TEST_F(KnownTable, TakesNoNumbersThatAreNone) {
  std::vector<SeenObject> broken = seen;
  broken[0].box = {NAN, 0, 10, 10};
  broken[1].box = {50, 50, 40, 40};
  const auto found = find(broken, things);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->thing[0], -1);
  EXPECT_EQ(found->thing[1], -1);
  EXPECT_TRUE(found->T_cw.is_finite());
}

// A map in which these things are born; the first keyframe is their reference.
void add_things(Map& map, const std::vector<KnownObject>& things) {
  const KeyframeId first = testing::keyframes_in(map).front();
  const SE3 T_rw = map.keyframes()[first].T_wc.inverse();
  for (const KnownObject& thing : things) {
    SeenObject s;
    s.box = {10, 10, 20, 20};
    s.class_name = thing.class_name;
    const ObjectId id =
        map.add_object(first, s, {T_rw * thing.ellipsoid.T, thing.ellipsoid.semi_axes});
    map.objects()[id].born = true;
  }
}

TEST_F(KnownTable, PlacesAFrameWithoutAnyPoints) {
  std::vector<SE3> poses;  // on the other side of the table
  for (const double x : {-1.5, -1.3}) poses.push_back(looking({x, 0.9, 1.4}, {0, 0, 0.1}, 0));
  Map map = testing::map_of(testing::points_on(things[0].ellipsoid, 40), poses);
  add_things(map, things);
  const auto frame = testing::frame_at({}, 9);
  const auto found = relocalize_with_objects(*frame, map, seen, {}, 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inliers, 0);
  EXPECT_EQ(found->objects, 6);
  EXPECT_TRUE(found->points.empty());
  EXPECT_LT(testing::rotation_error_deg(found->T_wc, T_wc), 2);
  EXPECT_LT(share_of_distance(found->T_wc, T_wc), 0.05);
  ASSERT_NE(found->view, nullptr);
  EXPECT_TRUE(found->view->pose_of(found->view->reference).has_value());
}

TEST(ObjectRelocalization, HandsOverToPointsWhereThereAreSome) {
  testing::PointWorld world(64);
  std::vector<SE3> poses;
  for (int i = 0; i < 6; ++i) poses.push_back(testing::along(0.35 * i));
  Map map = testing::true_map(world, poses);
  const std::vector<std::string> classes = {"tv", "chair", "teddy bear", "backpack", "clock"};
  const double places[5][3] = {
      {-0.8, 0.6, 4}, {1.2, -0.7, 4.5}, {0.3, 0.9, 5}, {1.9, 0.7, 4.2}, {0.1, -0.8, 3.6}};
  std::vector<KnownObject> things;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d centre(places[i][0], places[i][1], places[i][2]);
    things.push_back(
        {{SE3(so3_exp(Eigen::Vector3d(0.1 * i, 0.3, 0)), centre), Eigen::Vector3d(0.3, 0.25, 0.2)},
         classes[i]});
  }
  add_things(map, things);
  Random random(65);
  const SE3 T_wc = testing::along(0.8);
  const auto frame = world.show(T_wc, 100);
  const auto found = relocalize_with_objects(*frame, map, see(things, T_wc, random), {}, 1);
  ASSERT_TRUE(found);
  EXPECT_GE(found->inliers, 30);
  EXPECT_GE(found->objects, 3);
  ASSERT_EQ(found->points.size(), frame->size());
  EXPECT_LT((found->T_wc.translation() - T_wc.translation()).norm(), 0.03);
  EXPECT_LT(testing::rotation_error_deg(found->T_wc, T_wc), 0.4);
}

}  // namespace
}  // namespace cairn
