#include "cairn/association/object_association.h"

#include <gmock/gmock.h>

#include "map/things.h"

namespace cairn {
namespace {

using testing::a_cup;
using testing::around;
using testing::keyframes_in;
using testing::seen_thing;
using Kind = ObjectDecision::Kind;

// Two cups side by side, of 20 points each; the first keyframe knows both, the last one looks.
class ObjectAssociation : public ::testing::Test {
 protected:
  ObjectAssociation() {
    std::vector<Eigen::Vector3d> points = testing::points_on(left, 20);
    const auto more = testing::points_on(right, 20);
    points.insert(points.end(), more.begin(), more.end());
    map = testing::map_of(points, around(2, 10));
    const std::vector<PointId> ids = testing::points_of(map);
    first = keyframes_in(map).front();
    looking = keyframes_in(map).back();
    for (long i = 0; i < 2; ++i) {
      const Ellipsoid& thing = i == 0 ? left : right;
      known[i] = map.add_object(first, seen_thing(map, first, thing), thing);
      map.set_object_in_world(known[i], thing);
      map.objects()[known[i]].points.assign(ids.begin() + 20 * i, ids.begin() + 20 * (i + 1));
    }
  }
  std::vector<ObjectDecision> decide(const std::vector<SeenObject>& seen) const {
    return associate_objects(map, looking, seen, {});
  }
  void forget_points() {
    for (const ObjectId id : known) map.objects()[id].points.clear();
  }

  const Ellipsoid left = a_cup({-0.12, 0, 1.2}), right = a_cup({0.12, 0, 1.2});
  Map map{testing::point_view()};
  KeyframeId first, looking;
  std::array<ObjectId, 2> known;
};

TEST_F(ObjectAssociation, KnowsThingsByThePointsOnThem) {
  const auto decisions =
      decide({seen_thing(map, looking, right), seen_thing(map, looking, left, "bowl")});
  EXPECT_EQ(decisions[0].kind, Kind::kKnown);
  EXPECT_EQ(decisions[0].object, known[1]);
  EXPECT_EQ(decisions[1].kind, Kind::kKnown) << "a detector's flicker splits no object";
  EXPECT_EQ(decisions[1].object, known[0]);
}

TEST_F(ObjectAssociation, KnowsThingsWithoutPointsByWhereTheyAre) {
  forget_points();
  const auto decisions = decide({seen_thing(map, looking, right)});
  EXPECT_EQ(decisions[0].kind, Kind::kKnown);
  EXPECT_EQ(decisions[0].object, known[1]);
}

TEST_F(ObjectAssociation, GivesAThingToOneBoxOnly) {
  const SeenObject twice = seen_thing(map, looking, right);
  const auto decisions = decide({twice, twice});
  EXPECT_EQ(decisions[0].kind == Kind::kKnown, decisions[1].kind != Kind::kKnown);
  EXPECT_NE(decisions[0].kind, Kind::kNew);
  EXPECT_NE(decisions[1].kind, Kind::kNew) << "the second box of a thing is no second thing";
}

TEST_F(ObjectAssociation, SaysThatAThingElsewhereOrOfAnotherKindIsNew) {
  SeenObject keyboard = seen_thing(map, looking, left, "keyboard");
  keyboard.box.x1 += keyboard.box.width();
  const auto decisions = decide({seen_thing(map, looking, a_cup({0, 0.25, 1.2})), keyboard});
  EXPECT_EQ(decisions[0].kind, Kind::kNew);
  EXPECT_EQ(decisions[1].kind, Kind::kNew);
}

TEST_F(ObjectAssociation, TakesAThingOfAnotherKindInTheSamePlaceForAMistakenName) {
  const SeenObject wrong = seen_thing(map, looking, left, "microwave");
  const auto alone = decide({wrong});
  EXPECT_EQ(alone[0].kind, Kind::kKnown);
  EXPECT_EQ(alone[0].object, known[0]);
  const auto both = decide({wrong, seen_thing(map, looking, left)});
  EXPECT_EQ(both[1].object, known[0]) << "one of its own kind comes first";
  EXPECT_EQ(both[0].kind, Kind::kUnclear);
}

TEST_F(ObjectAssociation, DecidesNothingBetweenTheThresholds) {
  SeenObject part = seen_thing(map, looking, left);
  part.box.x1 = part.box.x0 + 0.25 * part.box.width();  // few points, little overlap
  const auto decisions = decide({part});
  EXPECT_EQ(decisions[0].kind, Kind::kUnclear);
}

TEST_F(ObjectAssociation, TakesAPartOfAThingAtTheBorderForNoSecondOne) {
  forget_points();
  SeenObject part = seen_thing(map, looking, right);
  part.box.x0 += 0.8 * part.box.width();
  EXPECT_EQ(decide({part})[0].kind, Kind::kNew) << "a small thing before a large one";
  part.cut[2] = true;
  EXPECT_EQ(decide({part})[0].kind, Kind::kNew) << "of what is only guessed nothing is a part";
  map.objects()[known[1]].born = true;
  EXPECT_EQ(decide({part})[0].kind, Kind::kUnclear);
}

TEST_F(ObjectAssociation, TakesAPartOfABoxAtTheBorderForNoSecondThing) {
  forget_points();
  SeenObject whole = seen_thing(map, looking, right);
  SeenObject part = whole;
  part.box.x0 += 0.8 * part.box.width();
  EXPECT_EQ(decide({part, whole})[0].kind, Kind::kNew);
  whole.cut[2] = true;
  EXPECT_EQ(decide({part, whole})[0].kind, Kind::kUnclear);
}

TEST_F(ObjectAssociation, OfNothingIsNothing) {
  EXPECT_THAT(decide({}), ::testing::IsEmpty());
  const Map empty = testing::map_of(testing::points_on(left, 9), around(2, 10));
  const std::vector<SeenObject> seen = {seen_thing(empty, empty.newest(), left)};
  EXPECT_EQ(associate_objects(empty, empty.newest(), seen, {})[0].kind, Kind::kNew);
}

}  // namespace
}  // namespace cairn
