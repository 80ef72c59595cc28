#include "cairn/mapping/object_birth.h"

#include <gtest/gtest.h>

#include "cairn/mapping/upward.h"
#include "map/things.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::around;
using testing::keyframes_in;
using testing::map_of;
using testing::points_on;
using testing::seen_thing;

const Vector3d kUp = -Vector3d::UnitY();  // as the first camera of around() is held

// A thing whose axes are given, its second one turned from upright by `tilt` about its first.
Ellipsoid lying(const Vector3d& semi_axes, double tilt = 0) {
  return {SE3(so3_exp(Vector3d(0, 0.4, 0)) * so3_exp(Vector3d(tilt, 0, 0)), {0, 0, 1.2}),
          semi_axes};
}

// The thing as all cameras of an arc see it, with the guess that its first box gives.
struct Film {
  Film(const Ellipsoid& thing, const std::string& class_name, double span_deg)
      : map(map_of(points_on(thing, 20), around(12, span_deg))) {
    map.units_a_metre = 1;
    for (const KeyframeId id : keyframes_in(map)) {
      const SeenObject seen = seen_thing(map, id, thing, class_name);
      if (map.objects().empty()) {
        map.add_object(id, seen, guess_ellipsoid(map, map.keyframes()[id], seen));
      } else {
        map.observe_object(testing::objects_of(map)[0], id, seen);
      }
    }
    map.objects()[testing::objects_of(map)[0]].independent = 4;
  }
  BoxFit fit() const { return fit_to_boxes(map, map.objects()[testing::objects_of(map)[0]]); }
  // Of the fit, relative to the reference.
  double overlap(const Ellipsoid& thing, const BoxFit& found) const {
    const SE3& T_wr = map.keyframes()[keyframes_in(map)[0]].T_wc;
    const Ellipsoid& e = found.fit.ellipsoid;
    return intersection_over_union({T_wr * e.T, e.semi_axes}, thing);
  }
  Map map;
};

TEST(FitToBoxes, FindsAKeyboardFlatWhereUpIsKnownAndThickWhereItIsNot) {
  const Ellipsoid keyboard = lying({0.27, 0.02, 0.09});
  Film film(keyboard, "keyboard", 15);
  const BoxFit thick = film.fit();
  EXPECT_EQ(thick.likeness, Likeness::kSize);
  film.map.up = {kUp, 0.05};
  const BoxFit flat = film.fit();
  EXPECT_EQ(flat.likeness, Likeness::kSizeAndShape);
  EXPECT_GT(film.overlap(keyboard, flat), film.overlap(keyboard, thick) + 0.1);
}

TEST(FitToBoxes, LetsABottleLieThatItsBoxesShowLying) {
  const Ellipsoid bottle = lying({0.045, 0.16, 0.045}, M_PI / 2);
  Film film(bottle, "bottle", 50);
  film.map.up = {kUp, 0.05};
  EXPECT_EQ(film.fit().likeness, Likeness::kSize);
  EXPECT_GT(film.overlap(bottle, film.fit()), 0.6);
}

TEST(FitToBoxes, TakesWhatIsOfNoKnownClassAsItIs) {
  Film film(lying({0.1, 0.08, 0.12}), "anvil", 40);
  film.map.up = {kUp, 0.05};
  EXPECT_EQ(film.fit().likeness, Likeness::kSize);
  EXPECT_TRUE(film.fit().fit.usable);
}

TEST(FitToBoxes, BelievesNoNameThatItsBoxesDeny) {
  const Ellipsoid tub = lying({0.17, 0.06, 0.1});
  Film film(tub, "cell phone", 60);
  film.map.up = {kUp, 0.05};
  EXPECT_NE(film.fit().likeness, Likeness::kNothing) << "a guess has to be like its class";
  film.map.objects()[testing::objects_of(film.map)[0]].born = true;
  const BoxFit found = film.fit();
  EXPECT_EQ(found.likeness, Likeness::kNothing);
  EXPECT_GT(film.overlap(tub, found), 0.7);
}

// Why a thing is none whose fit knows its place to `sigma` metres along each axis.
std::string refusal_of(const Film& film, const Ellipsoid& thing, double sigma) {
  const ObjectLandmark& landmark = film.map.objects()[testing::objects_of(film.map)[0]];
  ObjectFit fit = film.fit().fit;
  fit.ellipsoid.semi_axes = thing.semi_axes;
  fit.covariance.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
  return refusal(film.map, landmark, fit, {});
}

// 24 cm are a fifth of the distance: for a cup that is nowhere, for a table it is a place.
TEST(Refusal, OfAnUnsurePlaceIsASmallThingsOnly) {
  for (const double size : {0.1, 1.0}) {
    const Ellipsoid thing = lying({size, 0.4 * size, 0.5 * size});
    Film film(thing, "anvil", 40);
    const ObjectLandmark& landmark = film.map.objects()[testing::objects_of(film.map)[0]];
    EXPECT_EQ(refusal(film.map, landmark, film.fit().fit, {}), "") << size;
    film.map.points().for_each([](PointId, MapPoint& point) { point.position.z() += 1; });
    EXPECT_EQ(refusal_of(film, thing, 0.24), size < 0.5 ? "place unsure" : "") << size;
  }
}

TEST(Refusal, BelievesAnUnsurePlaceWhereTheMapsPointsLie) {
  const Ellipsoid thing = lying({0.1, 0.04, 0.05});
  const Film film(thing, "anvil", 40);
  EXPECT_EQ(refusal_of(film, thing, 0.24), "");
  EXPECT_EQ(refusal_of(film, thing, 0.5), "place unsure");  // that could as well be chance
}

TEST(Refusal, ForgivesWhatWasBornAFewMoreBoxes) {
  Film film(lying({0.1, 0.04, 0.05}), "anvil", 40);
  ObjectLandmark& landmark = film.map.objects()[testing::objects_of(film.map)[0]];
  ObjectFit fit = film.fit().fit;
  ASSERT_EQ(refusal(film.map, landmark, fit, {}), "");
  const auto with = [&](bool born, double share) {
    landmark.born = born;
    fit.views = 100, fit.agreeing = int(100 * share);
    return refusal(film.map, landmark, fit, {});
  };
  EXPECT_EQ(with(false, 0.61), "");
  EXPECT_EQ(with(false, 0.58), "boxes disagree");
  EXPECT_EQ(with(true, 0.58), "");
  EXPECT_EQ(with(true, 0.48), "boxes disagree");
}

TEST(FindUp, IsTheDirectionThatNoCameraIsRolledAbout) {
  const auto up = find_up(map_of({}, around(12, 60)));
  ASSERT_TRUE(up);
  EXPECT_LT((up->direction - kUp).norm(), 0.05);
}

TEST(FindUp, IsUnknownWhereCamerasHaveNotTurned) {
  EXPECT_FALSE(find_up(map_of({}, around(12, 3))));
}

TEST(FindUp, IsTheNormalOfATableWhereOneIsSeen) {
  Map map = map_of({}, around(12, 3));
  const KeyframeId first = keyframes_in(map)[0];
  const auto corners = testing::rectangle({-0.5, 0.4, 0.8}, {1, 0, 0}, {0, 0, 0.8});
  map.add_plane(first, testing::seen_from(map.keyframes()[first].T_wc, corners, "table"));
  const auto up = find_up(map);
  ASSERT_TRUE(up);
  EXPECT_LT((up->direction - kUp).norm(), 1e-6);
}

// Chairs are about 0.41 m in semi-axes; a box shows them smaller where a table hides them.
TEST(Refusal, OfAStrangeSizeIsSoonerATooLargeThings) {
  for (const double size : {0.09, 1.2}) {
    Film film(lying({0.2, 0.25, 0.2}), "chair", 40);
    ObjectFit fit = film.fit().fit;
    fit.ellipsoid.semi_axes = Vector3d::Constant(size);
    const ObjectLandmark& landmark = film.map.objects()[testing::objects_of(film.map)[0]];
    EXPECT_EQ(refusal(film.map, landmark, fit, {}), size > 1 ? "not of its class's size" : "");
  }
}

}  // namespace
}  // namespace cairn
