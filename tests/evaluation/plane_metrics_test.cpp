#include "cairn/evaluation/plane_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cairn {
namespace {

using Eigen::Vector3d;

// A unit square in the plane z = height, its middle at (x, y).
std::vector<Vector3d> square(double x, double y, double height, double half = 0.5) {
  return {{x - half, y - half, height},
          {x + half, y - half, height},
          {x + half, y + half, height},
          {x - half, y + half, height}};
}

TruePlane true_table() {
  TruePlane plane;
  plane.normal = {0, 0, 1};
  plane.d = -0.7;
  plane.parts = {square(0, 0, 0.7)};
  return plane;
}

// Through (x, y, height), tilted about the x axis.
FoundPlane found_table(double x, double y, double height, double tilt_deg = 0) {
  FoundPlane plane;
  const double a = tilt_deg * M_PI / 180;
  plane.normal = {0, -std::sin(a), std::cos(a)};
  plane.d = -plane.normal.dot(Vector3d(x, y, height));
  for (const Vector3d& corner : square(0, 0, 0, 0.2)) {
    plane.outline.push_back(so3_exp({a, 0, 0}) * corner + Vector3d(x, y, height));
  }
  return plane;
}

TEST(PlaneMetrics, MeasureAngleAndOffsetAtTheMiddleOfTheOutline) {
  const std::vector<TruePlane> truth = {true_table()};
  const std::vector<FoundPlane> found = {found_table(0.3, 0.2, 0.74, 5)};
  const PlaneMetrics m = plane_metrics(truth, found);
  EXPECT_NEAR(*m.angle_deg, 5, 1e-9);
  EXPECT_NEAR(*m.offset, 0.04, 1e-12);
  EXPECT_EQ(*m.precision, 1);
  EXPECT_EQ(*m.recall, 1);
}

TEST(PlaneMetrics, CallPlanesFalseThatAreTiltedOffOrElsewhere) {
  const std::vector<TruePlane> truth = {true_table()};
  for (const auto& [plane, ok] : {std::pair{found_table(0, 0, 0.7, 9.9), true},
                                  {found_table(0, 0, 0.7, 10.1), false},
                                  {found_table(0, 0, 0.799), true},
                                  {found_table(0, 0, 0.601), true},
                                  {found_table(0, 0, 0.801), false},
                                  {found_table(0.59, 0, 0.7), true},
                                  {found_table(0.61, 0, 0.7), false},
                                  {found_table(0.45, 0.45, 0.7), true},
                                  {found_table(0.58, 0.58, 0.7), false}}) {
    const PlaneMetrics m = plane_metrics(truth, std::vector<FoundPlane>{plane});
    EXPECT_EQ(m.correct, ok ? 1u : 0u);
    EXPECT_EQ(m.false_planes, ok ? 0u : 1u);
    EXPECT_EQ(m.missed, ok ? 0u : 1u);
  }
}

TEST(PlaneMetrics, DoNotCareOnWhichSideTheNormalIs) {
  FoundPlane turned = found_table(0, 0, 0.7);
  turned.normal = -turned.normal;
  turned.d = -turned.d;
  const PlaneMetrics m =
      plane_metrics(std::vector<TruePlane>{true_table()}, std::vector<FoundPlane>{turned});
  EXPECT_EQ(m.correct, 1u);
  EXPECT_NEAR(*m.angle_deg, 0, 1e-9);
}

TEST(PlaneMetrics, CountASurfaceThatIsFoundTwiceAsDuplicated) {
  std::vector<TruePlane> truth = {true_table(), true_table(), true_table()};
  truth[1].d = -2;  // a ceiling-like one that is not found
  truth[1].parts = {square(0, 0, 2)};
  truth[2].d = -3;  // and one that was hardly seen
  truth[2].parts = {square(0, 0, 3)};
  truth[2].visible_frames = 2;
  const std::vector<FoundPlane> found = {found_table(0.1, 0, 0.75), found_table(-0.1, 0, 0.71),
                                         found_table(0, 0, 3), found_table(0, 0, 1.5)};
  const PlaneMetrics m = plane_metrics(truth, found);
  EXPECT_EQ(m.correct, 1u);
  EXPECT_EQ(m.duplicated, 1u);
  EXPECT_EQ(m.false_planes, 1u);
  EXPECT_EQ(m.missed, 1u);
  EXPECT_NEAR(*m.precision, 1.0 / 3, 1e-12);
  EXPECT_NEAR(*m.recall, 1.0 / 2, 1e-12);
  EXPECT_NEAR(*m.offset, 0.01, 1e-12);  // the nearer one is the match
}

TEST(PlaneMetrics, KnowTheInsideOfAnOutlineThatIsNotConvex) {
  TruePlane floor = true_table();  // an L; the corner that it leaves out is at x > 0, y > 0
  floor.parts = {
      {{-2, -2, 0.7}, {2, -2, 0.7}, {2, 0, 0.7}, {0, 0, 0.7}, {0, 2, 0.7}, {-2, 2, 0.7}}};
  const std::vector<TruePlane> truth = {floor};
  EXPECT_EQ(plane_metrics(truth, std::vector{found_table(-1, 1, 0.7)}).correct, 1u);
  EXPECT_EQ(plane_metrics(truth, std::vector{found_table(1, -1, 0.7)}).correct, 1u);
  EXPECT_EQ(plane_metrics(truth, std::vector{found_table(1, 1, 0.7)}).correct, 0u);
}

TEST(PlaneMetrics, FindAnLWhoseMiddleIsNotOnIt) {
  TruePlane floor = true_table();  // two arms, half a metre wide
  floor.parts = {{{-2, -2, 0.7},
                  {2, -2, 0.7},
                  {2, -1.5, 0.7},
                  {-1.5, -1.5, 0.7},
                  {-1.5, 2, 0.7},
                  {-2, 2, 0.7}}};
  FoundPlane found;
  found.normal = floor.normal;
  found.d = floor.d;
  found.outline = floor.parts[0];
  EXPECT_EQ(plane_metrics(std::vector{floor}, std::vector{found}).correct, 1u);
  found.outline = {{-2, -2, 0.7}, {2, -2, 0.7}, {2, 2, 0.7}, {-2, 2, 0.7}};
  EXPECT_EQ(plane_metrics(std::vector{floor}, std::vector{found}).correct, 0u)
      << "most of it is elsewhere";
}

}  // namespace
}  // namespace cairn
