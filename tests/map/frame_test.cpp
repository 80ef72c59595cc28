#include "cairn/map/frame.h"

#include <gtest/gtest.h>

#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::Random;

const Camera& freiburg1() {
  static const Camera camera(Camera::Model::kRadialTangential, 640, 480,
                             {517.306408, 516.469215, 318.643040, 255.313989},
                             {0.262383, -0.953104, -0.005358, 0.002628, 1.163314});
  return camera;
}

Features random_features(int count, std::uint64_t seed) {
  Random random(seed);
  Features features;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(0, 639), y = random.uniform(0, 479);
    features.keypoints.push_back({float(x), float(y), 0.5F, 1, std::int8_t(i % 8)});
    features.descriptors.push_back({random.next(), 0, 0, static_cast<std::uint64_t>(i)});
  }
  return features;
}

TEST(Undistorter, AgreesWithTheCameraOnAHundredthOfAPixel) {
  const Features distorted = random_features(3000, 1);
  Features features = distorted;
  Undistorter(freiburg1()).apply(features);
  ASSERT_EQ(features.size(), distorted.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& from = distorted.keypoints[i];
    const Keypoint& to = features.keypoints[i];
    const Eigen::Vector2d expected = freiburg1().undistort({from.x, from.y});
    EXPECT_NEAR(to.x, expected.x(), 0.01) << from.x << " " << from.y;
    EXPECT_NEAR(to.y, expected.y(), 0.01) << from.x << " " << from.y;
    EXPECT_EQ(to.octave, from.octave);
    EXPECT_EQ(features.descriptors[i], distorted.descriptors[i]);
  }
}

TEST(Undistorter, LeavesThePixelsOfAPinholeAlone) {
  const Features before = random_features(100, 2);
  Features features = before;
  Undistorter(Camera(Camera::Model::kRadialTangential, 640, 480, testing::kCamera)).apply(features);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(features.keypoints[i].x, before.keypoints[i].x);
    EXPECT_EQ(features.keypoints[i].y, before.keypoints[i].y);
  }
}

TEST(Undistorter, RemovesWhatNoPinholeCanSee) {
  // 640 pixels over about 230 degrees: the corners look backwards.
  const Camera fisheye(Camera::Model::kKannalaBrandt, 640, 480, {160, 160, 320, 240});
  Features features = random_features(2000, 3);
  for (std::size_t i = 0; i < features.size(); ++i) features.descriptors[i][1] = i;
  const Features before = features;
  Undistorter(fisheye).apply(features);
  EXPECT_LT(features.size(), 2000u);
  EXPECT_GT(features.size(), 200u);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& kp = features.keypoints[i];
    ASSERT_TRUE(std::isfinite(kp.x) && std::isfinite(kp.y));
    // Descriptors went along with their keypoints.
    EXPECT_EQ(kp.octave, before.keypoints[features.descriptors[i][1]].octave);
  }
}

TEST(Undistorter, NotesWhenEachRowWasRead) {
  const Features before = random_features(500, 5);
  for (const Camera& camera :
       {freiburg1(), Camera(Camera::Model::kRadialTangential, 640, 480, testing::kCamera)}) {
    Features features = before;
    Frame frame;
    Undistorter(camera).apply(features, &frame.rows);
    ASSERT_EQ(frame.rows.size(), features.size());
    for (std::size_t i = 0; i < features.size(); ++i) {
      // Of the row in the picture, not of where its pinhole would see it.
      EXPECT_NEAR(frame.moment(i), (before.keypoints[i].y + 0.5) / 480 - 0.5, 0.5 / 256 + 1e-6);
    }
  }
}

Frame rolling_frame() {
  Frame frame;
  frame.features = random_features(300, 6);
  Undistorter(Camera(Camera::Model::kRadialTangential, 640, 480, testing::kCamera))
      .apply(frame.features, &frame.rows);
  frame.grid.build(frame.features.keypoints);
  return frame;
}

TEST(Frame, IsUnrolledFromWhatItsRowsSawHoweverOften) {
  const Vector6d velocity = (Vector6d() << 0.2, 0, 0.1, 0.1, 0.3, -0.1).finished();
  const std::vector<double> depths(300, 2.0);
  Frame frame = rolling_frame();
  unroll(frame, testing::kCamera, depths, 0.04, 2 * velocity);
  unroll(frame, testing::kCamera, depths, 0.025, velocity);
  EXPECT_EQ(frame.readout, 0.025);
  EXPECT_EQ(frame.velocity, velocity);
  double farthest = 0;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Eigen::Vector2d expected = seen_at_once(testing::kCamera, frame.sighted_pixel(i), 2,
                                                  frame.moment(i), 0.025 * velocity);
    EXPECT_LT((frame.pixel(i) - expected).norm(), 1e-3);
    farthest = std::max(farthest, (frame.pixel(i) - frame.sighted_pixel(i)).norm());
    // It is found where it is now.
    bool found = false;
    frame.for_each_near(expected.cast<float>(), 1, 0, 8, [&](std::uint32_t k) { found |= k == i; });
    EXPECT_TRUE(found);
  }
  EXPECT_GT(farthest, 1);
  unroll(frame, testing::kCamera, depths, 0, velocity);
  EXPECT_EQ(frame.features.keypoints, rolling_frame().features.keypoints);
}

TEST(Frame, WithoutRowsWasSeenAtOnce) {
  Frame frame = rolling_frame();
  frame.rows.clear();
  unroll(frame, testing::kCamera, {}, 0.025, Vector6d::Ones());
  EXPECT_EQ(frame.features.keypoints, rolling_frame().features.keypoints);
  EXPECT_EQ(frame.sighted_pixel(7), frame.pixel(7));
}

TEST(View, ContainsEveryUndistortedPixelOfThePicture) {
  const View view(freiburg1(), 8, 1.2, 1);
  Features features = random_features(2000, 4);
  Undistorter(freiburg1()).apply(features);
  for (const Keypoint& kp : features.keypoints) {
    EXPECT_GE(kp.x, view.min_x() - 0.1);
    EXPECT_GE(kp.y, view.min_y() - 0.1);
    EXPECT_LE(kp.x, view.max_x() + 0.1);
    EXPECT_LE(kp.y, view.max_y() + 0.1);
  }
  EXPECT_FALSE(view.contains({view.min_x() - 1, 200}));
  EXPECT_FALSE(view.contains({200, view.max_y() + 1}));
}

TEST(View, OfAFisheyeIsBounded) {
  const View view(Camera(Camera::Model::kKannalaBrandt, 640, 480, {160, 160, 320, 240}), 8, 1.2, 1);
  EXPECT_LE(view.max_x() - view.min_x(), 640 * 6);
  EXPECT_GT(view.max_x() - view.min_x(), 320);
}

TEST(View, OctavesGrowByTheScaleOfThePyramidAndSigmaWithThem) {
  const View view(freiburg1(), 8, 1.2, 0.8);
  EXPECT_EQ(view.levels(), 8);
  EXPECT_EQ(view.scale(0), 1);
  for (int i = 1; i < view.levels(); ++i) {
    EXPECT_NEAR(view.scale(i) / view.scale(i - 1), 1.2, 1e-9);
    EXPECT_GT(view.sigma(i), view.sigma(i - 1) * 0.999);
  }
  EXPECT_NEAR(view.log_scale_factor(), std::log(1.2), 1e-12);
}

}  // namespace
}  // namespace cairn
