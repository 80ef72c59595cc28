#include "cairn/mapping/object_mapping.h"

#include <gmock/gmock.h>

#include "cairn/mapping/object_support.h"
#include "cairn/mapping/size_scale.h"
#include "map/things.h"

namespace cairn {
namespace {

using testing::a_cup;
using testing::around;
using testing::keyframes_in;
using testing::objects_of;
using testing::Random;
using testing::seen_thing;
using ::testing::SizeIs;

class MapObjectsOfPictures : public ::testing::Test {
 protected:
  void film(int pictures, double span_deg) {
    map = testing::map_of(testing::points_on(a_cup(), 40), around(pictures, span_deg));
    map.units_a_metre = 1;
    keyframes = keyframes_in(map);
  }
  void show(KeyframeId id, const std::vector<SeenObject>& objects) {
    KeyframePerception seen;
    seen.frame = map.keyframes()[id].frame;
    seen.objects = objects;
    map_objects(map, id, seen, options, refusals);
  }
  SeenObject noisy(SeenObject seen, double pixels) {
    seen.box.x0 += pixels * random.gaussian();
    seen.box.y0 += pixels * random.gaussian();
    seen.box.x1 += pixels * random.gaussian();
    seen.box.y1 += pixels * random.gaussian();
    return seen;
  }
  void show_cup_everywhere(const std::string& class_name = "cup") {
    for (const KeyframeId id : keyframes) {
      show(id, {noisy(seen_thing(map, id, a_cup(), class_name), 0.5)});
    }
  }

  void show_in(std::initializer_list<std::size_t> pictures, const Ellipsoid& thing) {
    for (const std::size_t i : pictures) {
      show(keyframes[i], {seen_thing(map, keyframes[i], thing)});
    }
  }

  /// What fusion gives to the other, should both be one.
  ObjectLandmark lesser_copy_of(ObjectId id) {
    ObjectLandmark copy = map.objects()[id];
    copy.sightings -= 3;
    return copy;
  }

  Random random{5};
  Map map{testing::point_view()};
  std::vector<KeyframeId> keyframes;
  ObjectMappingOptions options;
  std::map<std::string, int> refusals;
};

TEST_F(MapObjectsOfPictures, AThingSeenFromManySidesIsBornOnceAndWhereItIs) {
  film(12, 50);
  show_cup_everywhere();
  ASSERT_THAT(objects_of(map), SizeIs(1));
  const ObjectLandmark& cup = map.objects()[objects_of(map)[0]];
  EXPECT_TRUE(cup.born);
  EXPECT_GT(cup.points.size(), 10u);
  settle_objects(map, options);
  ASSERT_THAT(objects_of(map), SizeIs(1));
  EXPECT_TRUE(cup.confirmed);
  const Ellipsoid found = map.object_in_world(objects_of(map)[0]);
  EXPECT_LT((found.centre() - a_cup().centre()).norm(), 0.01);
  EXPECT_GT(intersection_over_union(found, a_cup()), 0.8);
  EXPECT_LT(std::sqrt(cup.covariance.trace()), 0.05);
}

TEST_F(MapObjectsOfPictures, WithoutParallaxNothingIsBornAndTheReasonIsCounted) {
  film(12, 2);
  show_cup_everywhere();
  ASSERT_THAT(objects_of(map), SizeIs(1));
  EXPECT_FALSE(map.objects()[objects_of(map)[0]].born);
  EXPECT_GT(refusals["too little parallax"], 0);
  EXPECT_GT(refusals["too few views"], 0);
  settle_objects(map, options);
  EXPECT_THAT(objects_of(map), SizeIs(0));
}

TEST_F(MapObjectsOfPictures, BoxesThatDisagreeBearNothing) {
  film(12, 50);
  for (const KeyframeId id : keyframes) {
    show(id, {noisy(seen_thing(map, id, a_cup()), 14)});
  }
  settle_objects(map, options);
  EXPECT_THAT(objects_of(map), SizeIs(0));
}

TEST_F(MapObjectsOfPictures, OnlyPicturesThatAgreeCountForTheFinalMap) {
  for (const int asked : {4, 5}) {
    film(6, 50);
    show_cup_everywhere();
    ObjectLandmark& cup = map.objects()[objects_of(map)[0]];
    for (const std::size_t i : {1, 3}) {
      cup.observations[i].box.x0 += 60;
      cup.observations[i].box.x1 += 60;
    }
    options.min_sightings = asked;
    settle_objects(map, options);
    EXPECT_THAT(objects_of(map), SizeIs(asked == 4 ? 1 : 0)) << "four of six agree";
  }
}

TEST_F(MapObjectsOfPictures, WhatIsCutOnBothSidesWaitsForABetterPicture) {
  film(2, 10);
  SeenObject seen = seen_thing(map, keyframes[0], a_cup());
  seen.cut[0] = seen.cut[2] = true;
  show(keyframes[0], {seen});
  EXPECT_THAT(objects_of(map), SizeIs(0));
  show(keyframes[1], {seen_thing(map, keyframes[1], a_cup())});
  EXPECT_THAT(objects_of(map), SizeIs(1));
}

TEST_F(MapObjectsOfPictures, AnObjectThatShouldBeSeenAndIsNotDies) {
  film(60, 40);
  for (std::size_t i = 0; i < 12; ++i)
    show(keyframes[4 * i], {seen_thing(map, keyframes[4 * i], a_cup())});
  ASSERT_THAT(objects_of(map), SizeIs(1));
  ASSERT_TRUE(map.objects()[objects_of(map)[0]].born);
  for (int i = 0; i < 47 && !map.objects().empty(); ++i) show(keyframes[i + 1], {});
  EXPECT_THAT(objects_of(map), SizeIs(0));
}

TEST_F(MapObjectsOfPictures, AnObjectThatTheDetectorSeesInEveryFourthPictureLives) {
  film(60, 40);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    std::vector<SeenObject> seen;
    if (i % 4 == 0) seen = {seen_thing(map, keyframes[i], a_cup())};
    show(keyframes[i], seen);
  }
  settle_objects(map, options);
  EXPECT_THAT(objects_of(map), SizeIs(1));
}

TEST_F(MapObjectsOfPictures, AGuessThatNobodyConfirmsIsForgotten) {
  film(20, 10);
  show(keyframes[0], {seen_thing(map, keyframes[0], a_cup())});
  EXPECT_THAT(objects_of(map), SizeIs(1));
  for (std::size_t i = 1; i < keyframes.size(); ++i) show(keyframes[i], {});  // a second each
  EXPECT_THAT(objects_of(map), SizeIs(0));
}

TEST_F(MapObjectsOfPictures, TwoObjectsThatBecomeOneAreFused) {
  film(12, 50);
  show_cup_everywhere();
  const ObjectId cup = objects_of(map)[0];
  map.objects().insert(lesser_copy_of(cup));
  show(keyframes.back(), {});
  EXPECT_THAT(objects_of(map), ::testing::ElementsAre(cup));
}

TEST_F(MapObjectsOfPictures, OfTwoNamesOneThingKeepsTheOneThatMorePicturesGive) {
  film(12, 50);
  show_cup_everywhere("mouse");
  const ObjectId mouse = objects_of(map)[0];
  ObjectLandmark copy = lesser_copy_of(mouse);
  copy.votes = {{"donut", 0.5}};
  map.objects().insert(copy);
  show(keyframes.back(), {});
  ASSERT_THAT(objects_of(map), ::testing::ElementsAre(mouse));
  EXPECT_EQ(map.objects()[mouse].class_name(), "mouse");
}

TEST_F(MapObjectsOfPictures, AGuessOfAnotherNameWhoseBoxesShowAThingIsThatThing) {
  film(12, 50);
  show_cup_everywhere("tv");
  const ObjectId tv = objects_of(map)[0];
  ObjectLandmark vague = lesser_copy_of(tv);  // too thick, and too far away
  vague.votes = {{"microwave", 0.5}};
  vague.ellipsoid.semi_axes *= 2;
  vague.ellipsoid.T = SE3(vague.ellipsoid.T.rotation(), 1.1 * vague.ellipsoid.centre());
  ObjectLandmark beside = vague;
  for (ObjectObservation& o : beside.observations) {
    o.box.x1 = o.box.x0;
    o.box.x0 -= 20;
  }
  const ObjectId other = map.objects().insert(beside);
  show(keyframes.back(), {});
  EXPECT_THAT(objects_of(map), ::testing::ElementsAre(tv, other)) << "its boxes show another place";
  map.erase_object(other);
  map.objects().insert(vague);
  show(keyframes.back(), {});
  EXPECT_THAT(objects_of(map), ::testing::ElementsAre(tv));
}

TEST_F(MapObjectsOfPictures, AThingThatMayBeFarOffIsTheOneThatItsBoxesShow) {
  film(12, 50);
  show_cup_everywhere();
  const ObjectId cup = objects_of(map)[0];
  ObjectLandmark behind = lesser_copy_of(cup);
  behind.ellipsoid.T = SE3(behind.ellipsoid.T.rotation(), 1.5 * behind.ellipsoid.centre());
  const ObjectId other = map.objects().insert(behind);
  show(keyframes.back(), {});
  EXPECT_THAT(objects_of(map), ::testing::ElementsAre(cup, other)) << "its place is sure";
  map.objects()[other].covariance = Eigen::Vector3d(0.01, 0.01, 0.09).asDiagonal();
  show(keyframes.back(), {});
  EXPECT_THAT(objects_of(map), ::testing::ElementsAre(cup));
}

TEST_F(MapObjectsOfPictures, TwoGuessesThatOneThingExplainsAreThatThing) {
  film(24, 50);
  options.probation = 100;
  show_in({0, 1, 2}, a_cup());
  ASSERT_THAT(objects_of(map), SizeIs(1));
  // Taken to be where later boxes do not look for it.
  ObjectLandmark& behind = map.objects()[objects_of(map)[0]];
  behind.ellipsoid.T = SE3(behind.ellipsoid.T.rotation(), 2 * behind.ellipsoid.centre());
  show_in({20}, a_cup());
  ASSERT_THAT(objects_of(map), SizeIs(2));
  show_in({21}, a_cup());
  ASSERT_THAT(objects_of(map), SizeIs(1));
  const ObjectId cup = objects_of(map)[0];
  EXPECT_TRUE(map.objects()[cup].born);
  EXPECT_EQ(map.objects()[cup].sightings, 5u);
  EXPECT_LT((map.object_in_world(cup).centre() - a_cup().centre()).norm(), 0.01);
}

TEST_F(MapObjectsOfPictures, TwoGuessesThatOnePictureShowsBothAreNotOneThing) {
  film(24, 50);
  options.probation = 100;
  show_in({0, 1, 2}, a_cup());
  ObjectLandmark& behind = map.objects()[objects_of(map)[0]];
  behind.ellipsoid.T = SE3(behind.ellipsoid.T.rotation(), 2 * behind.ellipsoid.centre());
  const Ellipsoid farther = map.object_in_world(objects_of(map)[0]);
  show_in({20}, a_cup());
  ASSERT_THAT(objects_of(map), SizeIs(2));
  const KeyframeId both = keyframes[21];
  show(both, {seen_thing(map, both, a_cup()), seen_thing(map, both, farther)});
  EXPECT_THAT(objects_of(map), SizeIs(2));
}

TEST_F(MapObjectsOfPictures, TwoGuessesOfNeighboursStayTwo) {
  film(24, 50);
  options.probation = 100;
  const Ellipsoid right = a_cup({0.3, 0, 1.2});
  show_in({0, 1, 2}, a_cup());
  show_in({20, 21, 22}, right);
  EXPECT_THAT(objects_of(map), SizeIs(2));
}

TEST_F(MapObjectsOfPictures, BoxesOfItsNeighbourDoNotCostAnObjectItsPlace) {
  film(24, 50);
  const Ellipsoid left = a_cup(), right = a_cup({0.15, 0, 1.2});
  for (const KeyframeId id : keyframes) {
    show(id, {noisy(seen_thing(map, id, left), 0.5), noisy(seen_thing(map, id, right), 0.5)});
  }
  ASSERT_THAT(objects_of(map), SizeIs(2));
  ObjectLandmark& mixed = map.objects()[objects_of(map)[1]];
  const auto other = map.objects()[objects_of(map)[0]].observations;
  for (std::size_t i = 0; i < 15; ++i) mixed.observations[i].box = other[i].box;
  settle_objects(map, options);
  ASSERT_THAT(objects_of(map), SizeIs(2));
  EXPECT_THAT(mixed.observations, SizeIs(9));
}

TEST_F(MapObjectsOfPictures, AThingStandsOnTheTableUnderItAndNotOnOneFarBelow) {
  film(12, 50);
  show_cup_everywhere();
  const ObjectId cup = objects_of(map)[0];
  const auto add_table = [&](double y) {  // y is down
    const auto corners = testing::rectangle({-0.5, y, 0.8}, {1, 0, 0}, {0, 0, 0.8});
    const PlaneId id = map.add_plane(
        keyframes[0], testing::seen_from(map.keyframes()[keyframes[0]].T_wc, corners, "table"));
    map.planes()[id].confirmed = true;
    return id;
  };
  const PlaneId low = add_table(0.4);
  find_supports(map, 1, 0.05, 0.1);
  EXPECT_FALSE(map.objects()[cup].support.valid());
  const PlaneId near = add_table(0.065);
  find_supports(map, 1, 0.05, 0.1);
  EXPECT_EQ(map.objects()[cup].support, near);
  find_supports(map, 1, 0, 0.05);
  EXPECT_EQ(map.objects()[cup].support, near) << "it is held longer than it would be taken";
  find_supports(map, 1, 0, 0);
  EXPECT_FALSE(map.objects()[cup].support.valid());
  find_supports(map, 1, 0.05, 0.1);
  find_supports(map, 0.01, 0.05, 0.1);
  EXPECT_FALSE(map.objects()[cup].support.valid()) << "where a metre is small, it is far above";
  find_supports(map, 1, 0.05, 0.1);
  map.erase_plane(near);
  EXPECT_FALSE(map.objects()[cup].support.valid());
  map.erase_plane(low);
}

TEST_F(MapObjectsOfPictures, SizesOfThingsSayWhatAMetreIs) {
  film(12, 50);
  EXPECT_FALSE(scale_from_sizes(map).known());
  map.units_a_metre = 0;
  show_cup_everywhere();
  settle_objects(map, options);
  const ScaleEstimate scale = scale_from_sizes(map);
  ASSERT_TRUE(scale.known());
  EXPECT_EQ(scale.how, "object sizes");
  EXPECT_NEAR(std::log(scale.value), 0, 2 * scale.sigma) << "a cup of about usual size, in metres";
}

TEST_F(MapObjectsOfPictures, WhereThePicturesMetreIsNotTrustedThingsAreFoundWithoutIt) {
  film(12, 50);
  map.units_a_metre = 12;
  show_cup_everywhere();
  settle_objects(map, options);
  EXPECT_FALSE(scale_from_sizes(map).known()) << "no cup is that small";
  film(12, 50);
  map.units_a_metre = 12;
  map.units_a_metre_by_sizes = 0;
  show_cup_everywhere();
  settle_objects(map, options);
  const ScaleEstimate scale = scale_from_sizes(map);
  ASSERT_TRUE(scale.known());
  EXPECT_NEAR(std::log(scale.value), 0, 2 * scale.sigma);
}

TEST(ScaleOfTwoSources, IsTheSurerMeanWhereTheyAgreeAndTheSurerOneWhereNot) {
  const ScaleEstimate depth{"predicted depth", 1.0, 0.2, 9, {}};
  const ScaleEstimate sizes{"object sizes", 1.2, 0.1, 4, {}};
  const ScaleEstimate both = joined(depth, sizes);
  EXPECT_GT(both.value, 1.1);
  EXPECT_LT(both.value, 1.2);
  EXPECT_LT(both.sigma, 0.1);
  EXPECT_THAT(both.parts, SizeIs(2));
  const ScaleEstimate wrong{"object sizes", 4.0, 0.1, 4, {}};
  EXPECT_EQ(joined(depth, wrong).value, 4.0);
  EXPECT_EQ(joined(depth, {}).value, 1.0);
  EXPECT_EQ(joined({}, sizes).how, "object sizes");
  const ScaleEstimate measured{"measured depth", 1.0, 0.01, 9, {}};
  EXPECT_NEAR(joined(measured, sizes).value, 1.0, 0.005);
}

}  // namespace
}  // namespace cairn
