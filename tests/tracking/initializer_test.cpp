#include "cairn/tracking/initializer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "map/point_world.h"

namespace cairn {
namespace {

using testing::along;
using testing::point_view;
using testing::PointWorld;

constexpr double kFrame = 1 / 30.0;  // seconds

TEST(Initializer, StartsFromAMotionToTheSide) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    PointWorld world(seed);
    Initializer initializer(point_view(), {}, seed);
    std::optional<InitialPair> pair;
    for (int i = 0; i < 40 && !pair; ++i) {
      pair = initializer.add(world.show(along(0.04 * i), i * kFrame));
      if (!pair && i > 0) {
        EXPECT_FALSE(initializer.refusal().empty()) << i;
      }
    }
    ASSERT_TRUE(pair.has_value()) << initializer.refusal();
    const SE3 truth = world.truth(*pair->frame2).inverse() * world.truth(*pair->frame1);
    EXPECT_LT(testing::rotation_error_deg(pair->T_21, truth), 1);
    EXPECT_LT(testing::direction_error_deg(pair->T_21, truth), 10);
    EXPECT_NEAR(pair->T_21.translation().norm(), 1, 1e-6);
    ASSERT_GE(pair->points.size(), 60u);
    std::size_t same = 0, near = 0;
    for (const InitialPair::Point& p : pair->points) {
      const int shown = world.point_of(*pair->frame1, p.keypoint1);
      same += shown >= 0 && shown == world.point_of(*pair->frame2, p.keypoint2);
      ASSERT_TRUE(p.position.allFinite());
      EXPECT_GT(p.position.z(), 0);
      if (shown < 0) continue;
      const Eigen::Vector3d X = world.truth(*pair->frame1).inverse() * world.position(shown);
      near += std::abs(p.position.z() * truth.translation().norm() / X.z() - 1) < 0.25;
    }
    EXPECT_GT(same, 0.97 * pair->points.size());
    EXPECT_GT(near, 0.8 * pair->points.size());
  }
}

TEST(Initializer, RefusesARotationOnTheSpotAndSaysSo) {
  PointWorld world(4);
  Initializer initializer(point_view(), {}, 0);
  for (int i = 0; i < 25; ++i) {
    const SE3 T_wc(so3_exp({0.004 * i, 0.012 * i, 0}), Eigen::Vector3d::Zero());
    ASSERT_FALSE(initializer.add(world.show(T_wc, i * kFrame)).has_value()) << i;
  }
  EXPECT_THAT(initializer.refusal(), ::testing::HasSubstr(" ")) << "a sentence";
}

TEST(Initializer, RefusesACameraThatStandsStill) {
  PointWorld world(5);
  Initializer initializer(point_view(), {}, 0);
  for (int i = 0; i < 25; ++i) {
    ASSERT_FALSE(initializer.add(world.show(SE3(), i * kFrame)).has_value()) << i;
  }
  EXPECT_FALSE(initializer.refusal().empty());
}

TEST(Initializer, RefusesPicturesWithTooFewKeypointsAndSaysHowMany) {
  PointWorld world(6, {.count = 60, .clutter = 0});
  Initializer initializer(point_view(), {}, 0);
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(initializer.add(world.show(along(0.1 * i), i * kFrame)).has_value());
  }
  EXPECT_THAT(initializer.refusal(), ::testing::ContainsRegex("[0-9]+ keypoints"));
}

TEST(Initializer, RefusesPicturesThatHaveNothingInCommon) {
  PointWorld here(7), there(8);
  Initializer initializer(point_view(), {}, 0);
  for (int i = 0; i < 10; ++i) {
    PointWorld& world = i % 2 == 0 ? here : there;
    ASSERT_FALSE(initializer.add(world.show(along(0.1 * i), i * kFrame)).has_value());
  }
  EXPECT_FALSE(initializer.refusal().empty());
}

TEST(Initializer, KeepsThePicturesOfThePair) {
  PointWorld world(10);
  Initializer initializer(point_view(), {}, 3);
  std::map<const Frame*, std::shared_ptr<const Picture>> pictures;
  std::optional<InitialPair> pair;
  for (int i = 0; i < 40 && !pair; ++i) {
    const auto frame = world.show(along(0.04 * i), i * kFrame);
    pictures[frame.get()] = std::make_shared<Picture>();
    pair = initializer.add(frame, pictures[frame.get()]);
  }
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->picture1, pictures[pair->frame1.get()]);
  EXPECT_EQ(pair->picture2, pictures[pair->frame2.get()]);
}

TEST(Initializer, DrawsTheSamePairFromTheSameSeed) {
  auto run = [] {
    PointWorld world(9);
    Initializer initializer(point_view(), {}, 3);
    std::vector<double> numbers;
    for (int i = 0; i < 40 && numbers.empty(); ++i) {
      const auto pair = initializer.add(world.show(along(0.04 * i), i * kFrame));
      if (!pair) continue;
      for (const auto& p : pair->points) numbers.push_back(p.position.x());
    }
    return numbers;
  };
  const auto first = run();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, run());
}

}  // namespace
}  // namespace cairn
