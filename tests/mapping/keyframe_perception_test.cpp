#include "cairn/mapping/keyframe_perception.h"

#include <gmock/gmock.h>

#include "geometry/planes.h"
#include "map/flat_map.h"

namespace cairn {
namespace {

using ::testing::IsEmpty;
using testing::IsNearPlane;
using testing::kCamera;
using testing::point_view;
using ::testing::SizeIs;

const Camera kLens(Camera::Model::kRadialTangential, 640, 480, kCamera);
const cv::Rect kInside(200, 100, 201, 161);
const Plane kTilted(Eigen::Vector3d(0.3, -0.4, 0.85).normalized(), -3);

// Keypoints every 20 pixels.
std::vector<Eigen::Vector2d> pixels() {
  std::vector<Eigen::Vector2d> result;
  for (int y = 10; y < 480; y += 20) {
    for (int x = 10; x < 640; x += 20) result.emplace_back(x, y);
  }
  return result;
}

bool inside(const Eigen::Vector2d& pixel) {
  return kInside.contains(cv::Point(int(pixel.x()), int(pixel.y())));
}

DetectedPlane detected() {
  DetectedPlane plane;
  plane.plane << kTilted.normal(), kTilted.offset();
  plane.label = "table";
  plane.score = 0.75;
  plane.mask = cv::Mat::zeros(480, 640, CV_8U);
  plane.mask(kInside).setTo(255);
  plane.sigma_angle = 0.07;
  plane.sigma_depth = 0.04;
  return plane;
}

KeyframePerception summary_of(const DetectedFrame& frame) {
  return summarize_perception(frame, testing::frame_at(pixels(), 1), kLens, point_view());
}

TEST(KeyframePerception, OfAPlaneIsWhatItsMaskShows) {
  DetectedFrame frame;
  frame.planes = {detected()};
  frame.sigma_scale = 0.1;
  const KeyframePerception summary = summary_of(frame);
  ASSERT_THAT(summary.planes, SizeIs(1));
  EXPECT_EQ(summary.sigma_scale, 0.1);
  const SeenPlane& seen = summary.planes[0];
  EXPECT_THAT(seen.plane, IsNearPlane(kTilted, 1e-6, 1e-9));
  EXPECT_EQ(seen.label, "table");
  EXPECT_EQ(seen.score, 0.75);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < pixels().size(); ++i) {
    if (inside(pixels()[i])) expected.push_back(i);
  }
  ASSERT_THAT(expected, SizeIs(10 * 8));
  EXPECT_EQ(seen.keypoints, expected);
  EXPECT_NEAR(kTilted.signed_distance(seen.centroid), 0, 1e-9);
  EXPECT_LT((kCamera.project(seen.centroid) - Eigen::Vector2d(300, 180)).norm(), 1);
  ASSERT_THAT(seen.outline, SizeIs(4));
  for (const Eigen::Vector3d& corner : seen.outline) {
    EXPECT_NEAR(kTilted.signed_distance(corner), 0, 1e-9);
    const Eigen::Vector2d off = kCamera.project(corner) - Eigen::Vector2d(300, 180);
    EXPECT_NEAR(std::abs(off.x()), 100, 2);
    EXPECT_NEAR(std::abs(off.y()), 80, 2);
  }
  EXPECT_EQ(seen.sigma_angle, 0.07);
  EXPECT_NEAR(seen.sigma_offset, 0.04 * seen.centroid.norm(), 1e-12);
}

TEST(KeyframePerception, KeypointsJustOutsideOfTheMaskAreBesideIt) {
  DetectedFrame frame;
  frame.planes = {detected()};
  EXPECT_THAT(summary_of(frame).planes[0].beside, IsEmpty()) << "the next ones are 10 pixels off";
  frame.planes[0].mask.colRange(388, 640).setTo(0);  // those at 390
  const SeenPlane seen = summary_of(frame).planes[0];
  ASSERT_THAT(seen.beside, SizeIs(8));
  for (const std::uint32_t i : seen.beside) {
    EXPECT_EQ(pixels()[i].x(), 390);
    EXPECT_TRUE(inside(pixels()[i]));
  }
  EXPECT_THAT(seen.keypoints, SizeIs(9 * 8));
}

TEST(KeyframePerception, CountsWhatHangsOnAWallAmongItsKeypointsAtTheRim) {
  DetectedFrame frame;
  frame.planes = {detected()};
  frame.planes[0].mask(cv::Rect(260, 140, 60, 60)).setTo(0);  // a poster
  const auto without = summary_of(frame).planes[0];
  frame.planes[0].label = "wall";
  const auto with = summary_of(frame).planes[0];
  EXPECT_EQ(with.keypoints.size(), without.keypoints.size() + 3 * 3);
  EXPECT_EQ(with.inner, without.inner);
}

TEST(KeyframePerception, HasTheDepthOfThePlanesWhereTheDetectorGivesNone) {
  DetectedFrame frame;
  frame.planes = {detected()};
  const KeyframePerception summary = summary_of(frame);
  ASSERT_THAT(summary.depth, SizeIs(pixels().size()));
  for (std::size_t i = 0; i < pixels().size(); ++i) {
    const double depth = kTilted.depth_along(kCamera.unproject(pixels()[i])).value_or(0);
    EXPECT_NEAR(summary.depth[i], inside(pixels()[i]) ? depth : 0, 1e-5) << i;
  }
}

TEST(KeyframePerception, HasTheDepthOfTheDetectorWhereItGivesOne) {
  DetectedFrame frame;
  frame.planes = {detected()};
  frame.depth = cv::Mat(240, 320, CV_32F, cv::Scalar(0));  // of half the size
  frame.depth(cv::Rect(160, 0, 160, 240)).setTo(cv::Scalar(2.5));
  const KeyframePerception summary = summary_of(frame);
  for (std::size_t i = 0; i < pixels().size(); ++i) {
    EXPECT_EQ(summary.depth[i], pixels()[i].x() < 320 ? 0.0f : 2.5f) << i;
  }
}

TEST(KeyframePerception, KnowsTheRangeOfAllDepthsOfThePicture) {
  DetectedFrame frame;
  frame.depth = cv::Mat(240, 320, CV_32F, cv::Scalar(2));
  frame.depth.rowRange(0, 60).setTo(0);  // unknown
  frame.depth.rowRange(60, 120).setTo(NAN);
  frame.depth.rowRange(120, 180).setTo(8);
  const DepthRange range = summary_of(frame).range;
  EXPECT_NEAR(range.mean, std::log(4), 1e-6);
  EXPECT_NEAR(range.variance, std::log(2) * std::log(2), 1e-6);
  EXPECT_FALSE(summary_of({}).range.known());
}

TEST(KeyframePerception, LeavesOutPlanesThatCannotBe) {
  DetectedFrame frame;
  frame.planes.assign(7, detected());
  frame.planes[0].plane[1] = NAN;
  frame.planes[1].plane.setZero();
  frame.planes[2].plane[3] = 3;  // behind the camera
  frame.planes[3].mask = cv::Mat();
  frame.planes[4].mask.setTo(0);  // shared with all others by cv::Mat
  for (const int i : {0, 1, 2, 5, 6}) frame.planes[i].mask = detected().mask;
  frame.planes[5].plane << 0, 0.8, 0.6, INFINITY;
  EXPECT_THAT(summary_of(frame).planes, SizeIs(1));
  frame.planes.pop_back();
  const KeyframePerception summary = summary_of(frame);
  EXPECT_THAT(summary.planes, IsEmpty());
  for (const float depth : summary.depth) EXPECT_EQ(depth, 0);
}

}  // namespace
}  // namespace cairn
