#include "cairn/mapping/metric_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cairn {
namespace {

PictureScale picture(double scale) {
  PictureScale picture;
  picture.usable = true;
  picture.scale = scale;
  return picture;
}

TEST(MetricScale, IsFreeUntilAPictureSaysSomething) {
  const MetricScale scale;
  EXPECT_FALSE(scale.estimate().known());
  EXPECT_EQ(scale.estimate().value, 1);
  EXPECT_EQ(scale.estimate().pictures, 0);
  EXPECT_EQ(scale.picture_scale(), 0);
}

TEST(MetricScale, IsTheMedianOfThePictures) {
  MetricScale scale;
  for (const double units_a_metre : {0.5, 0.4, 40.0, 0.52, 0.001})
    scale.add(picture(units_a_metre), 0);
  EXPECT_NEAR(scale.estimate().value, 2, 1e-12);  // metres a unit
  EXPECT_NEAR(scale.picture_scale(), 0.5, 1e-12);
  EXPECT_EQ(scale.estimate().pictures, 5);
}

TEST(MetricScale, RefusesWhatIsNoScale) {
  MetricScale scale;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, std::nan(""), kInfinity, -kInfinity}) {
    scale.add(picture(wrong), 0.1);
  }
  EXPECT_FALSE(scale.estimate().known());
  scale.add(picture(0.25), 0);
  EXPECT_NEAR(scale.estimate().value, 4, 1e-12);
  EXPECT_EQ(scale.estimate().pictures, 1);
  EXPECT_EQ(scale.estimate().how, "measured depth") << "what was refused has no say";
}

TEST(MetricScale, MeasuredDepthGetsSurerWithMorePicturesAndPredictedDepthOnlySoFar) {
  for (const double sigma : {0.0, 0.08}) {
    MetricScale few, many;
    for (int i = 0; i < 900; ++i) {
      const double units = std::exp(0.1 * ((i % 9) - 4));  // median 1, median deviation 0.2
      many.add(picture(units), sigma);
      if (i < 9) few.add(picture(units), sigma);
    }
    EXPECT_EQ(few.estimate().how, sigma > 0 ? "predicted depth" : "measured depth");
    const double spread = 1.4826 * 0.2;
    EXPECT_NEAR(few.estimate().sigma, std::hypot(sigma, spread / 3), 1e-6);
    EXPECT_NEAR(many.estimate().sigma, std::hypot(sigma, spread / 30), 1e-6);
  }
}

TEST(MetricScale, ItsSigmaIsThatOfTheLeastSurePicture) {
  MetricScale scale;
  for (const double sigma : {0.02, 0.2, 0.05}) scale.add(picture(1), sigma);
  EXPECT_NEAR(scale.estimate().sigma, 0.2, 1e-12);
}

// Predicted depths have 0.6 of the range that they should have, from each picture's mean; the
// points of one picture are nearer than its mean, those of the next farther.
TEST(MetricScale, LearnsHowMuchANetworkShiesAwayFromNearAndFar) {
  MetricScale scale;
  for (int i = 0; i < 60; ++i) {
    PictureScale seen = picture(1);
    const double mapped = i % 3 == 0 ? 0.3 : -0.5;  // log of depth over the picture's mean, unit 2
    seen.predicted = 0.6 * mapped;
    seen.scale = 2 * std::exp(mapped - 0.6 * mapped);
    seen.variance = 0.1;
    seen.covariance = 0.06;
    scale.add(seen, 0.2);
  }
  EXPECT_NEAR(scale.contrast(), 1 / 0.6, 0.05);
  EXPECT_NEAR(scale.picture_scale(), 2, 0.05) << "of the oldest pictures as of the newest";
  MetricScale measured;
  PictureScale seen = picture(1);
  seen.variance = 1;
  measured.add(seen, 0);
  EXPECT_EQ(measured.contrast(), 1) << "measured depth is not stretched";
}

TEST(MetricScale, WhatAUserHasMeasuredMultipliesWhatWasFoundAndHasNoSigma) {
  const ScaleEstimate free = given_scale({}, 2.5);
  EXPECT_TRUE(free.known());
  EXPECT_EQ(free.how, "given");
  EXPECT_EQ(free.value, 2.5);
  EXPECT_EQ(free.sigma, 0);
  MetricScale scale;
  scale.add(picture(0.5), 0.1);
  const ScaleEstimate corrected = given_scale(scale.estimate(), 1.1);
  EXPECT_EQ(corrected.how, "given");
  EXPECT_NEAR(corrected.value, 2.2, 1e-12);
  EXPECT_EQ(corrected.sigma, 0);
}

}  // namespace
}  // namespace cairn
