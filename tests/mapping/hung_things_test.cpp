#include "cairn/mapping/hung_things.h"

#include <gtest/gtest.h>

namespace cairn {
namespace {

const cv::Size kSize(320, 240);
const cv::Rect kWall(0, 0, 320, 160), kTable(0, 160, 320, 80);

DetectedPlane plane_of(const char* label, const cv::Rect& where) {
  DetectedPlane plane;
  plane.label = label;
  plane.mask = cv::Mat::zeros(kSize, CV_8U);
  plane.mask(where).setTo(255);
  return plane;
}

// A wall above a table, with something before them.
class HungThings : public ::testing::Test {
 protected:
  int behind(const cv::Rect& thing) {
    for (DetectedPlane& plane : planes) plane.mask(thing).setTo(0);
    return hung_things(planes, kSize)(thing.y + thing.height / 2, thing.x + thing.width / 2);
  }
  std::vector<DetectedPlane> planes = {plane_of("table", kTable), plane_of("wall", kWall)};
};

TEST_F(HungThings, AreInFrontOfTheWallAlone) { EXPECT_EQ(behind({100, 40, 60, 50}), 1); }

TEST_F(HungThings, MayBeCutByTheEdgeOfThePicture) { EXPECT_EQ(behind({100, 0, 60, 50}), 1); }

TEST_F(HungThings, AreNotThoseThatStandOnSomethingElse) {
  EXPECT_EQ(behind({100, 80, 80, 85}), -1);
}

TEST_F(HungThings, DoNotHangOnTables) { EXPECT_EQ(behind({100, 180, 60, 30}), -1); }

TEST_F(HungThings, AreSmallerThanTheWall) { EXPECT_EQ(behind({5, 5, 310, 150}), -1); }

TEST_F(HungThings, AreMostlyInThePicture) { EXPECT_EQ(behind({0, 0, 320, 20}), -1); }

TEST_F(HungThings, AreNowhereWithoutPlanes) {
  const cv::Mat_<int> nothing = hung_things({}, kSize);
  EXPECT_EQ(cv::countNonZero(nothing != -1), 0);
}

TEST_F(HungThings, PassOverMasksOfAnotherSize) {
  planes[1].mask = cv::Mat::ones(10, 10, CV_8U);
  EXPECT_EQ(cv::countNonZero(hung_things(planes, kSize) != -1), 0);
}

}  // namespace
}  // namespace cairn
