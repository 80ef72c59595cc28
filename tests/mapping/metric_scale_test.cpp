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

TEST(MetricScale, IsTheMeanOfThePicturesThatAgree) {
  MetricScale scale;
  double time = 0;
  for (const double units_a_metre : {0.5, 0.4, 40.0, 0.625, 0.001})
    scale.add(time += 10, picture(units_a_metre), 0);
  EXPECT_NEAR(scale.estimate().value, 2, 1e-5);  // metres a unit
  EXPECT_NEAR(scale.picture_scale(), 0.5, 1e-5);
  EXPECT_EQ(scale.estimate().pictures, 5);
}

TEST(MetricScale, IsNoLessSureForOnePictureInFour) {
  MetricScale scale;
  EXPECT_EQ(scale.sigma(), 0);
  double time = 0;
  for (const double sigma : {0.2, 2.5, 0.2, 0.2}) scale.add(time += 10, picture(1), sigma);
  EXPECT_EQ(scale.sigma(), 0.2);
}

TEST(MetricScale, ManyPicturesInASecondSayHardlyMoreThanOne) {
  MetricScale scale;
  for (int i = 0; i <= 30; ++i) scale.add(i / 30.0, picture(1), 0.1);
  for (int i = 1; i <= 10; ++i) scale.add(1 + 10.0 * i, picture(i % 2 ? 1.2 : 1.1), 0.1);
  EXPECT_GT(scale.picture_scale(), 1.12);
  MetricScale shuffled;
  for (int i = 10; i > 0; --i) shuffled.add(1 + 10.0 * i, picture(i % 2 ? 1.2 : 1.1), 0.1);
  for (int i = 0; i <= 30; ++i) shuffled.add(i / 30.0, picture(1), 0.1);
  EXPECT_NEAR(shuffled.picture_scale(), scale.picture_scale(), 1e-12);
}

TEST(MetricScale, RefusesWhatIsNoScale) {
  MetricScale scale;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, std::nan(""), kInfinity, -kInfinity}) {
    scale.add(0, picture(wrong), 0.1);
  }
  EXPECT_FALSE(scale.estimate().known());
  scale.add(0, picture(0.25), 0);
  EXPECT_NEAR(scale.estimate().value, 4, 1e-12);
  EXPECT_EQ(scale.estimate().pictures, 1);
  EXPECT_EQ(scale.estimate().how, "measured depth") << "what was refused has no say";
}

// So far: what a network errs by in a scene, and how well depth cameras are calibrated.
TEST(MetricScale, GetsSurerWithMorePicturesButOnlySoFar) {
  for (const double sigma : {0.0, 0.08}) {
    MetricScale few, many;
    for (int i = 0; i < 900; ++i) {
      const double units = std::exp(0.1 * ((i % 9) - 4));  // median 1, median deviation 0.2
      many.add(10 * i, picture(units), sigma);
      if (i < 9) few.add(10 * i, picture(units), sigma);
    }
    EXPECT_EQ(few.estimate().how, sigma > 0 ? "predicted depth" : "measured depth");
    const double spread = 1.4826 * 0.2, least = sigma > 0 ? sigma : 0.01;
    EXPECT_NEAR(few.estimate().sigma, std::hypot(least, spread / 3), 1e-4);
    EXPECT_NEAR(many.estimate().sigma, std::hypot(least, spread / 30), 1e-4);
  }
}

TEST(MetricScale, ItsSigmaIsThatOfTheLeastSurePicture) {
  MetricScale scale;
  for (const double sigma : {0.02, 0.2, 0.05}) scale.add(10 * sigma, picture(1), sigma);
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
    scale.add(10 * i, seen, 0.2);
  }
  EXPECT_NEAR(scale.contrast(), 1 / 0.6, 0.05);
  EXPECT_NEAR(scale.picture_scale(), 2, 0.05) << "of the oldest pictures as of the newest";
  MetricScale measured;
  PictureScale seen = picture(1);
  seen.variance = 1;
  measured.add(0, seen, 0);
  EXPECT_EQ(measured.contrast(), 1) << "measured depth is not stretched";
}

TEST(MetricScale, WhatAUserHasMeasuredMultipliesWhatWasFoundAndHasNoSigma) {
  const ScaleEstimate free = given_scale({}, 2.5);
  EXPECT_TRUE(free.known());
  EXPECT_EQ(free.how, "given");
  EXPECT_EQ(free.value, 2.5);
  EXPECT_EQ(free.sigma, 0);
  MetricScale scale;
  scale.add(0, picture(0.5), 0.1);
  const ScaleEstimate corrected = given_scale(scale.estimate(), 1.1);
  EXPECT_EQ(corrected.how, "given");
  EXPECT_NEAR(corrected.value, 2.2, 1e-12);
  EXPECT_EQ(corrected.sigma, 0);
}

}  // namespace
}  // namespace cairn
