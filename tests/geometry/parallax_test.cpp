#include "cairn/geometry/parallax.h"

#include <gtest/gtest.h>

#include <vector>

namespace cairn {
namespace {

using Eigen::Vector3d;

TEST(LargestParallax, IsTheAngleBetweenTheOutermostEyesHoweverFarTheyAre) {
  const Vector3d point(1, -2, 0.5);
  std::vector<Vector3d> eyes;
  for (const double degrees : {10.0, -25.0, 40.0, 0.0}) {
    const double a = degrees * M_PI / 180, distance = 1 + 0.1 * (degrees + 30);
    eyes.push_back(point + distance * Vector3d(std::cos(a), std::sin(a), 0));
  }
  EXPECT_NEAR(largest_parallax(eyes, point) * 180 / M_PI, 65, 1e-9);
  eyes.push_back(point - Vector3d(2, 0, 0));
  EXPECT_NEAR(largest_parallax(eyes, point) * 180 / M_PI, 180, 1e-5) << "from two opposite sides";
}

TEST(LargestParallax, IsNoneOfOneView) {
  const std::vector<Vector3d> one = {Vector3d(0, 0, 0)};
  EXPECT_EQ(largest_parallax(one, Vector3d(0, 0, 1)), 0);
  EXPECT_EQ(largest_parallax(std::vector<Vector3d>(), Vector3d(0, 0, 1)), 0);
}

}  // namespace
}  // namespace cairn
