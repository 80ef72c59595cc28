#include "cairn/map/visibility.h"

#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

// A camera at the origin, a point straight ahead at distance 2 that was seen from there.
struct Ahead {
  SE3 T_cw;
  Eigen::Vector3d position{0, 0, 2};
  Eigen::Vector3f normal{0, 0, 1};
  float base_distance = 2;

  Visibility predict() const {
    return predict_visibility(testing::point_view(), T_cw, T_cw.inverse().translation(), position,
                              normal, base_distance);
  }
};

TEST(Visibility, APointSeenFromHereIsExpectedHere) {
  const Visibility v = Ahead().predict();
  ASSERT_TRUE(v.visible);
  EXPECT_NEAR((v.pixel - Eigen::Vector2d(319.5, 239.5)).norm(), 0, 1e-9);
  EXPECT_EQ(v.octave, 0);
  EXPECT_NEAR(v.cosine, 1, 1e-6);
}

TEST(Visibility, OctaveFollowsTheDistance) {
  for (int octave = 0; octave < 8; ++octave) {
    Ahead ahead;
    ahead.base_distance = static_cast<float>(2 * std::pow(1.2, octave));
    const Visibility v = ahead.predict();
    ASSERT_TRUE(v.visible) << octave;
    EXPECT_EQ(v.octave, octave);
  }
}

TEST(Visibility, WhatIsTooFarOrTooNearIsNotExpected) {
  Ahead ahead;
  ahead.position.z() = 4;  // twice the distance of octave 0
  EXPECT_FALSE(ahead.predict().visible);
  ahead.position.z() = 0.3;  // larger than the coarsest octave
  EXPECT_FALSE(ahead.predict().visible);
}

TEST(Visibility, WhatIsBehindOrBesideIsNotExpected) {
  Ahead ahead;
  ahead.position = {0, 0, -2};
  EXPECT_FALSE(ahead.predict().visible);
  ahead.position = {4, 0, 2};
  EXPECT_FALSE(ahead.predict().visible);
  ahead.position = {NAN, 0, 2};
  EXPECT_FALSE(ahead.predict().visible);
}

TEST(Visibility, WhatWasSeenFromTheOtherSideIsNotExpected) {
  Ahead ahead;
  ahead.normal = {0, 0, -1};
  EXPECT_FALSE(ahead.predict().visible);
  ahead.normal = Eigen::Vector3f(std::sin(0.5F), 0, std::cos(0.5F));
  const Visibility v = ahead.predict();
  EXPECT_TRUE(v.visible);
  EXPECT_NEAR(v.cosine, std::cos(0.5), 1e-6);
}

}  // namespace
}  // namespace cairn
