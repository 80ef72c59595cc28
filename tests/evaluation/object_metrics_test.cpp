#include "cairn/evaluation/object_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn {
namespace {

using Eigen::Vector3d;

TrueObject true_object(const std::string& name, const Vector3d& centre, const Vector3d& axes,
                       TurnSymmetry symmetry = TurnSymmetry::kNone) {
  TrueObject object;
  object.class_name = name;
  object.ellipsoid = {SE3(Eigen::Quaterniond::Identity(), centre), axes};
  object.symmetry = symmetry;
  object.visible_frames = 50;
  return object;
}

FoundObject found_object(const std::string& name, const Vector3d& centre, const Vector3d& axes,
                         const Vector3d& turn = Vector3d::Zero()) {
  FoundObject object;
  object.class_name = name;
  object.ellipsoid = {SE3(so3_exp(turn), centre), axes};
  return object;
}

const Vector3d kCupAxes(0.05, 0.05, 0.06);

TEST(ObjectMetrics, CountEachObjectOnceAsWhatItIs) {
  const std::vector<TrueObject> truth = {true_object("cup", {0, 0, 0}, kCupAxes),
                                         true_object("cup", {0.5, 0, 0}, kCupAxes),
                                         true_object("book", {0, 0.5, 0}, {0.1, 0.15, 0.02}),
                                         true_object("tv", {0, 0, 1}, {0.1, 0.5, 0.3})};
  const std::vector<FoundObject> found = {
      found_object("cup", {0.02, 0, 0}, kCupAxes),                // found
      found_object("cup", {0.05, 0, 0}, kCupAxes),                // the same one again
      found_object("bowl", {0.5, 0.01, 0}, kCupAxes),             // wrong class
      found_object("mouse", {0, 0.5, 0.02}, {0.01, 0.01, 0.01}),  // false: on the book, but no book
      found_object("cup", {3, 3, 3}, kCupAxes)};                  // false: nothing is there
  const ObjectMetrics m = object_metrics(truth, found);
  EXPECT_EQ(m.found, 2u);
  EXPECT_EQ(m.wrong_class, 1u);
  EXPECT_EQ(m.missed, 2u);
  EXPECT_EQ(m.duplicated, 1u);
  EXPECT_EQ(m.false_objects, 2u);
  EXPECT_NEAR(*m.centre_error, 0.015, 1e-12);
  ASSERT_EQ(m.matches.size(), 2u);
  EXPECT_EQ(m.matches[0].found, 0u);
  EXPECT_EQ(m.matches[1].found, 2u);
}

TEST(ObjectMetrics, DoNotBlameForWhatIsHardlySeen) {
  std::vector<TrueObject> truth = {true_object("cup", {0, 0, 0}, kCupAxes),
                                   true_object("cup", {1, 0, 0}, kCupAxes)};
  truth[0].visible_frames = truth[1].visible_frames = 9;
  const std::vector<FoundObject> found = {found_object("cup", {0, 0, 0}, kCupAxes)};
  const ObjectMetrics m = object_metrics(truth, found);
  EXPECT_EQ(m.found + m.missed + m.duplicated + m.false_objects, 0u);
  EXPECT_EQ(m.ignored, 1u);
  EXPECT_FALSE(m.iou.has_value());
  ObjectMetricsOptions options;
  options.min_visible_frames = 9;
  EXPECT_EQ(object_metrics(truth, found, options).found, 1u);
  EXPECT_EQ(object_metrics(truth, found, options).missed, 1u);
}

TEST(ObjectMetrics, DoNotBlameForWhatIsSeenFromOneSideOnly) {
  std::vector<TrueObject> truth = {true_object("cup", {0, 0, 0}, kCupAxes),
                                   true_object("cup", {1, 0, 0}, kCupAxes)};
  truth[0].visible_span_deg = 14;
  truth[1].visible_span_deg = 16;
  const ObjectMetrics m = object_metrics(truth, {});
  EXPECT_EQ(m.missed, 1u);
  ObjectMetricsOptions options;
  options.min_visible_span_deg = 1;
  EXPECT_EQ(object_metrics(truth, {}, options).missed, 2u);
}

TEST(ObjectMetrics, MatchNeighboursSuchThatAllAreServed) {
  // The first found one is nearest to the second true one, but the second one needs that.
  const std::vector<TrueObject> truth = {true_object("cup", {0, 0, 0}, kCupAxes),
                                         true_object("cup", {0.12, 0, 0}, kCupAxes)};
  const std::vector<FoundObject> found = {found_object("cup", {0.065, 0, 0}, kCupAxes),
                                          found_object("cup", {0.15, 0, 0}, kCupAxes)};
  const ObjectMetrics m = object_metrics(truth, found);
  ASSERT_EQ(m.found, 2u);
  EXPECT_EQ(m.matches[0].found, 0u);
  EXPECT_EQ(m.matches[1].found, 1u);
}

TEST(ObjectMetrics, TakeEmptyLists) {
  const ObjectMetrics nothing = object_metrics({}, {});
  EXPECT_EQ(nothing.found + nothing.missed + nothing.false_objects, 0u);
  const std::vector<FoundObject> found = {found_object("cup", {0, 0, 0}, kCupAxes)};
  EXPECT_EQ(object_metrics({}, found).false_objects, 1u);
  const std::vector<TrueObject> truth = {true_object("cup", {0, 0, 0}, kCupAxes)};
  EXPECT_EQ(object_metrics(truth, {}).missed, 1u);
}

TEST(CompareShapes, MeasuresTheTurnOfAThingWithoutSymmetry) {
  const TrueObject truth = true_object("laptop", {0, 0, 0}, {0.1, 0.2, 0.3});
  const auto difference = compare_shapes(
      truth, found_object("laptop", {0, 0, 0}, {0.11, 0.2, 0.27}, {0, 0, 0.3}).ellipsoid);
  EXPECT_NEAR(difference.rotation, 0.3, 1e-12);
  EXPECT_NEAR(difference.axis_error, (0.1 + 0 + 0.1) / 3, 1e-12);
}

TEST(CompareShapes, DoesNotCareHowTheAxesAreNamed) {
  const TrueObject truth = true_object("laptop", {0, 0, 0}, {0.1, 0.2, 0.3});
  // A quarter turn about z with x and y exchanged is the same ellipsoid; so is a half turn.
  const Vector3d quarter(0, 0, M_PI / 2), half(M_PI, 0, 0);
  for (const auto& [axes, turn] :
       {std::pair{Vector3d(0.2, 0.1, 0.3), quarter}, {Vector3d(0.1, 0.2, 0.3), half}}) {
    const auto same =
        compare_shapes(truth, found_object("laptop", {0, 0, 0}, axes, turn).ellipsoid);
    EXPECT_NEAR(same.rotation, 0, 1e-7);
    EXPECT_NEAR(same.axis_error, 0, 1e-12);
  }
}

TEST(CompareShapes, ForgivesTurnsThatTheClassDoesNotShow) {
  const Vector3d axes(0.1, 0.2, 0.3), turn(0, 0, 50 * M_PI / 180);
  const Ellipsoid turned = found_object("", {0, 0, 0}, axes, turn).ellipsoid;
  const auto rotation_deg = [&](TurnSymmetry symmetry) {
    return compare_shapes(true_object("", {0, 0, 0}, axes, symmetry), turned).rotation * 180 / M_PI;
  };
  EXPECT_NEAR(rotation_deg(TurnSymmetry::kNone), 50, 1e-9);
  EXPECT_NEAR(rotation_deg(TurnSymmetry::kHalfTurn), 50, 1e-9);
  EXPECT_NEAR(rotation_deg(TurnSymmetry::kQuarterTurn), 40, 1e-9);
  EXPECT_NEAR(rotation_deg(TurnSymmetry::kAnyTurn), 0, 1e-9);
  // Tilted by 20 degrees, and turned by anything about its own axis.
  const SE3 tilted(so3_exp({20 * M_PI / 180, 0, 0}) * so3_exp({0, 0, 1}), {0, 0, 0});
  const auto tilt =
      compare_shapes(true_object("", {0, 0, 0}, {0.1, 0.1, 0.3}, TurnSymmetry::kAnyTurn),
                     {tilted, {0.1, 0.1, 0.3}});
  EXPECT_NEAR(tilt.rotation * 180 / M_PI, 20, 1e-9);
  EXPECT_NEAR(tilt.axis_error, 0, 1e-12);
}

}  // namespace
}  // namespace cairn
