#include <gmock/gmock.h>

#include "cairn/map/map_view.h"
#include "cairn/map/object_classes.h"
#include "map/things.h"

namespace cairn {
namespace {

using testing::a_cup;
using testing::around;
using testing::keyframes_in;
using testing::objects_of;
using testing::seen_thing;
using ::testing::SizeIs;

class MapObjects : public ::testing::Test {
 protected:
  Ellipsoid cup_from(KeyframeId id) const {
    return {map.keyframes()[id].T_wc.inverse() * a_cup().T, a_cup().semi_axes};
  }
  Map map = testing::map_of(testing::points_on(a_cup(), 30), around(3, 20));
  const std::vector<KeyframeId> keyframes = keyframes_in(map);
  const ObjectId cup =
      map.add_object(keyframes[0], seen_thing(map, keyframes[0], a_cup()), cup_from(keyframes[0]));
};

TEST_F(MapObjects, AreRelativeToTheKeyframeThatSawThemFirst) {
  EXPECT_EQ(map.objects()[cup].reference, keyframes[0]);
  EXPECT_TRUE(map.object_in_world(cup).centre().isApprox(a_cup().centre(), 1e-12));
  const SE3 moved = SE3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 1));
  map.keyframes()[keyframes[0]].T_wc = moved * map.keyframes()[keyframes[0]].T_wc;
  EXPECT_TRUE(map.object_in_world(cup).centre().isApprox(
      a_cup().centre() + Eigen::Vector3d(0, 0, 1), 1e-12));
}

TEST_F(MapObjects, AreOfTheClassThatMostPicturesSay) {
  map.observe_object(cup, keyframes[1], seen_thing(map, keyframes[1], a_cup(), "bowl"));
  map.observe_object(cup, keyframes[2], seen_thing(map, keyframes[2], a_cup(), "cup"));
  EXPECT_EQ(map.objects()[cup].class_name(), "cup");
  EXPECT_EQ(map.objects()[cup].sightings, 3u);
  EXPECT_NEAR(map.objects()[cup].score(), 0.8, 1e-12);
}

TEST_F(MapObjects, KeepOneBoxAKeyframe) {
  map.observe_object(cup, keyframes[0], seen_thing(map, keyframes[0], a_cup()));
  EXPECT_THAT(map.objects()[cup].observations, SizeIs(1));
  EXPECT_EQ(map.objects()[cup].sightings, 1u);
}

// As many as are kept, spread over all the time that the thing was seen.
TEST(ObjectLandmark, KeepsWhatIsMostApartInTime) {
  constexpr std::size_t kMost = ObjectLandmark::kMostObservations;
  constexpr double kMean = 99.9 / double(kMost - 1);
  ObjectLandmark landmark;
  for (int i = 0; i < 1000; ++i) landmark.observe({.keyframe = {}, .box = {}, .time = 0.1 * i});
  ASSERT_THAT(landmark.observations, SizeIs(kMost));
  EXPECT_EQ(landmark.observations.front().time, 0);
  EXPECT_DOUBLE_EQ(landmark.observations.back().time, 99.9);
  for (std::size_t i = 1; i < kMost; ++i) {
    const double gap = landmark.observations[i].time - landmark.observations[i - 1].time;
    EXPECT_GT(gap, kMean / 3);
    EXPECT_LT(gap, kMean * 2);
  }
}

TEST(ObjectLandmark, HasTheOldestViewFirst) {
  ObjectLandmark landmark;
  for (const double t : {2., 1., 3.}) landmark.observe({.keyframe = {}, .box = {}, .time = t});
  EXPECT_EQ(landmark.observations[0].time, 1);
  EXPECT_EQ(landmark.observations[2].time, 3);
}

TEST_F(MapObjects, StayWhereTheyAreWhenTheirKeyframeGoes) {
  map.observe_object(cup, keyframes[1], seen_thing(map, keyframes[1], a_cup()));
  const SE3 camera = map.keyframes()[keyframes[0]].T_wc;
  map.erase_keyframe(keyframes[0]);
  ASSERT_THAT(objects_of(map), SizeIs(1));
  const auto& observations = map.objects()[cup].observations;
  ASSERT_THAT(observations, SizeIs(2)) << "what its picture showed is still true";
  EXPECT_TRUE(observations[0].buried);
  EXPECT_TRUE(map.camera_of(observations[0]).matrix().isApprox(camera.matrix(), 1e-9));
  EXPECT_NE(map.objects()[cup].reference, keyframes[0]);
  EXPECT_FALSE(map.objects()[cup].seen_by(keyframes[0]));
  EXPECT_TRUE(map.object_in_world(cup).centre().isApprox(a_cup().centre(), 1e-9));
}

TEST_F(MapObjects, HaveTheBoxesThatACameraWithoutTheLensWouldHave) {
  const Pinhole pinhole = map.view().pinhole();
  const ObjectObservation& o = map.objects()[cup].observations[0];
  const Box2 seen = o.box;
  map.set_lens({{0.01, -0.05, 0.02, 2, -1}});
  const Eigen::Vector2d middle = seen.centre();
  const auto bent = [&](double x, double y) {
    return map.lens().project(pinhole, pinhole.unproject({x, y}));
  };
  EXPECT_NEAR(bent(o.box.x0, middle.y()).x(), seen.x0, 0.5);
  EXPECT_NEAR(bent(middle.x(), o.box.y1).y(), seen.y1, 0.5);
  EXPECT_GT((o.box.edges() - seen.edges()).norm(), 2);
  map.set_lens({});
  EXPECT_LT((o.box.edges() - seen.edges()).norm(), 0.1) << "the lens is as calibrated again";
}

TEST_F(MapObjects, TakeOverTheBoxesOfWhatTheyAreFusedWith) {
  const ObjectId other = map.add_object(
      keyframes[1], seen_thing(map, keyframes[1], a_cup(), "bowl"), cup_from(keyframes[1]));
  map.observe_object(other, keyframes[0], seen_thing(map, keyframes[0], a_cup(), "bowl"));
  map.merge_objects(other, cup);
  ASSERT_THAT(objects_of(map), ::testing::ElementsAre(cup));
  EXPECT_THAT(map.objects()[cup].observations, SizeIs(2)) << "one picture, one box";
  EXPECT_EQ(map.objects()[cup].sightings, 2u);
  EXPECT_EQ(map.objects()[cup].votes.size(), 2u);
}

TEST_F(MapObjects, AreShownToTheTrackerOnceTheyAreBorn) {
  EXPECT_THAT(make_view(map, keyframes[0], 100, 1)->objects, SizeIs(0));
  map.objects()[cup].born = true;
  const auto view = make_view(map, keyframes[0], 100, 2);
  ASSERT_THAT(view->objects, SizeIs(1));
  EXPECT_EQ(view->objects[0].class_name, "cup");
}

TEST(ObjectClasses, AreThoseOfCocoWithSizes) {
  ASSERT_THAT(object_classes(), SizeIs(80));
  for (const ObjectClass& c : object_classes()) {
    EXPECT_GT(usual_size(c), 0.01) << c.name;
    EXPECT_GT(c.sigma, 0) << c.name;
    EXPECT_EQ(find_object_class(c.name), &c);
  }
  EXPECT_EQ(find_object_class("unicorn"), nullptr);
}

TEST(ObjectClasses, ShareAFamilyWhereDetectorsConfuseThem) {
  EXPECT_TRUE(may_be_one_class("cup", "bowl"));
  EXPECT_TRUE(may_be_one_class("vase", "cup"));
  EXPECT_TRUE(may_be_one_class("tv", "laptop"));
  EXPECT_TRUE(may_be_one_class("unicorn", "unicorn"));
  EXPECT_FALSE(may_be_one_class("cup", "keyboard"));
  EXPECT_FALSE(may_be_one_class("unicorn", "dragon"));
}

}  // namespace
}  // namespace cairn
