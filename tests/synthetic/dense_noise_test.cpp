#include "cairn/synthetic/dense_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

double apart(int i) { return 100.0 * i; }

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

TEST(NoisyDepth, HasAScaleForEachPicture) {
  const cv::Mat depth(48, 64, CV_32F, cv::Scalar(2));
  PerceptionNoise::Depth noise = PerceptionNoise::none().depth;
  noise.scale = 1.5;
  noise.scale_spread = 0.2;
  std::vector<double> scales;
  double squares = 0;
  for (int i = 0; i < 2000; ++i) {
    const cv::Mat said = noisy_depth(depth, noise, HashedNoise(1), apart(i));
    EXPECT_NEAR(said.at<float>(0, 0), said.at<float>(47, 63), 1e-5);
    scales.push_back(said.at<float>(0, 0) / 2.0);
    squares += std::pow(std::log(scales.back() / 1.5), 2);
  }
  EXPECT_NEAR(median(scales), 1.5, 0.02);
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.2, 0.01);
}

TEST(NoisyDepth, IsWrongWithinAPictureBySmoothFactors) {
  const cv::Mat depth(120, 160, CV_32F, cv::Scalar(3));
  PerceptionNoise::Depth noise = PerceptionNoise::none().depth;
  noise.local = 0.15;
  noise.local_length = 0.25;
  double variance = 0, near = 0, far = 0;
  constexpr int kTrials = 400;
  for (int i = 0; i < kTrials; ++i) {
    const cv::Mat said = noisy_depth(depth, noise, HashedNoise(2), apart(i));
    cv::Mat error = said / 3;
    cv::log(error, error);
    variance += error.dot(error) / error.total();
    const auto correlation = [&](int lag) {
      const cv::Mat a = error.colRange(0, 160 - lag), b = error.colRange(lag, 160);
      return a.dot(b) / double(a.total());
    };
    near += correlation(4);
    far += correlation(40);  // the correlation length
  }
  EXPECT_NEAR(std::sqrt(variance / kTrials), 0.15, 0.01);
  EXPECT_GT(near / variance, 0.95);
  EXPECT_NEAR(far / variance, std::exp(-1), 0.08);
}

TEST(NoisyDepth, BlursStepsAndKeepsAShareOfTheirHeight) {
  cv::Mat depth(240, 320, CV_32F, cv::Scalar(1));
  depth.colRange(160, 320) = 2;
  PerceptionNoise::Depth noise = PerceptionNoise::none().depth;
  noise.blur = 0.02;
  cv::Mat said = noisy_depth(depth, noise, HashedNoise(1), 0);
  EXPECT_NEAR(said.at<float>(120, 130), 1, 1e-3);
  EXPECT_NEAR(said.at<float>(120, 190), 2, 1e-3);
  // A Gaussian of 6.4 pixels: at one sigma 0.841 of the step is done.
  EXPECT_NEAR(said.at<float>(120, 166), 1 + 0.841, 0.03);
  noise.sharp = 0.3;
  noise.smear = 0.2;
  said = noisy_depth(depth, noise, HashedNoise(1), 0);
  const double step = std::log(said.at<float>(120, 176) / said.at<float>(120, 144));
  // 0.3 of the step, and of the rest what a Gaussian of 64 pixels does within 16 on each side.
  EXPECT_NEAR(step / std::log(2), 0.3 + 0.7 * 0.2, 0.04);
}

TEST(NoisyDepth, StaysNothingWhereNothingIs) {
  cv::Mat depth(120, 160, CV_32F, cv::Scalar(2));
  depth(cv::Rect(40, 30, 60, 60)) = 0;
  const cv::Mat said = noisy_depth(depth, {}, HashedNoise(1), 0);
  EXPECT_EQ(cv::countNonZero(said(cv::Rect(40, 30, 60, 60))), 0);
  EXPECT_EQ(cv::countNonZero(said), 120 * 160 - 3600);
  PerceptionNoise::Depth blur = PerceptionNoise::none().depth;
  blur.blur = 0.05;  // what is nothing does not blur in
  const cv::Mat blurred = noisy_depth(depth, blur, HashedNoise(1), 0);
  EXPECT_NEAR(blurred.at<float>(60, 38), 2, 1e-3);
}

TEST(NoisyNormals, AreTurnedByTheAngleThatIsAskedFor) {
  cv::Mat normals(60, 80, CV_32FC3, cv::Scalar(0.6, 0, -0.8));
  normals.at<cv::Vec3f>(5, 5) = {0, 0, 0};
  PerceptionNoise::Normals noise;
  noise.angle_deg = 10;
  std::vector<double> angles;
  for (int i = 0; i < 300; ++i) {
    const cv::Mat said = noisy_normals(normals, noise, HashedNoise(1), apart(i));
    EXPECT_EQ(said.at<cv::Vec3f>(5, 5), cv::Vec3f(0, 0, 0));
    for (const cv::Point& p : {cv::Point(10, 10), cv::Point(40, 30), cv::Point(75, 55)}) {
      const cv::Vec3f& n = said.at<cv::Vec3f>(p);
      EXPECT_NEAR(cv::norm(n), 1, 1e-5);
      angles.push_back(std::acos(n.dot(cv::Vec3f(0.6f, 0, -0.8f))) * 180 / M_PI);
    }
  }
  EXPECT_NEAR(median(angles), 10 * std::sqrt(2 * std::log(2.0)),
              0.8);  // of a Rayleigh distribution
}

TEST(RaggedMask, HasABorderThatIsDisplacedInAndOut) {
  cv::Mat mask(300, 300, CV_8U, cv::Scalar(0));
  mask(cv::Rect(100, 50, 100, 200)) = 255;
  const PerceptionNoise::Masks noise = {.ragged = 0.015};
  double squares = 0, sum = 0;
  constexpr int kTrials = 1500;
  for (int i = 0; i < kTrials; ++i) {
    const cv::Mat ragged =
        ragged_mask(mask, noise, HashedNoise(std::uint64_t(i)), 0).row(150 + i % 11);
    ASSERT_EQ(ragged.at<std::uint8_t>(150), 255);
    const double moved = cv::countNonZero(ragged.colRange(0, 150)) - 50;
    squares += moved * moved;
    sum += moved;
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials), 0.015 * std::sqrt(20'000), 0.3);
  EXPECT_NEAR(sum / kTrials, 0, 0.3);
}

TEST(RaggedMask, LeavesEmptyAndFullMasksAlone) {
  const cv::Mat empty(100, 100, CV_8U, cv::Scalar(0)), full(100, 100, CV_8U, cv::Scalar(255));
  const PerceptionNoise::Masks noise = {.ragged = 0.05};
  EXPECT_EQ(cv::countNonZero(ragged_mask(empty, noise, HashedNoise(1), 0)), 0);
  EXPECT_EQ(cv::countNonZero(ragged_mask(full, noise, HashedNoise(1), 0)), 10'000);
}

}  // namespace
}  // namespace cairn
