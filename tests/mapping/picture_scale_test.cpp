#include "cairn/mapping/picture_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "map/flat_map.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;

// A keyframe with points at these pixels, between 2 and 6 units away.
Map map_with(const std::vector<Eigen::Vector2d>& pixels, Random& random) {
  std::vector<Eigen::Vector3d> points;
  const std::vector<SE3> poses = testing::few_poses(2);
  for (const Eigen::Vector2d& pixel : pixels) {
    points.push_back(poses[1] * (random.uniform(2, 6) * kCamera.unproject(pixel)));
  }
  return testing::map_of(points, poses);
}

double depth_of(const Map& map, std::size_t i) {
  const Keyframe& keyframe = map.keyframes()[map.newest()];
  return (keyframe.T_wc.inverse() * map.points()[keyframe.points[i]].position).z();
}

std::vector<Eigen::Vector2d> anywhere(int count, Random& random) {
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < count; ++i)
    pixels.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
  return pixels;
}

// Depth as a detector predicts it: 2.5 units are a metre, 2 % noise, and a share far too near.
Map pictured(int count, double outliers) {
  Random random(8);
  Map map = map_with(anywhere(count, random), random);
  for (int i = 0; i < count; ++i) {
    const bool wrong = std::floor((i + 1) * outliers) > std::floor(i * outliers);
    const double error = wrong ? random.uniform(0.3, 0.7) : std::exp(0.02 * random.gaussian());
    map.keyframes()[map.newest()].depth.push_back(float(depth_of(map, i) / 2.5 * error));
  }
  return map;
}

TEST(AlignPicture, FindsTheScaleDespiteOutliers) {
  const Map map = pictured(400, 0.2);
  const PictureScale scale = align_picture(map, map.newest());
  EXPECT_TRUE(scale.usable);
  EXPECT_EQ(scale.points, 400);
  EXPECT_NEAR(scale.scale / 2.5, 1, 0.03);
  EXPECT_GT(scale.log_error, 0.015);
  EXPECT_LT(scale.log_error, 0.08);
}

TEST(AlignPicture, KnowsHowWellThePictureFits) {
  const Map map = pictured(200, 0);
  EXPECT_NEAR(align_picture(map, map.newest()).log_error, 0.02, 0.006);
}

TEST(AlignPicture, RefusesFewPoints) {
  Map map = pictured(40, 0);
  for (std::size_t i = 10; i < 40; ++i) map.keyframes()[map.newest()].depth[i] = 0;  // unknown
  const PictureScale scale = align_picture(map, map.newest());
  EXPECT_FALSE(scale.usable);
  EXPECT_EQ(scale.points, 10);
}

TEST(AlignPicture, ACrowdOfCornersHasNoMoreSayThanOtherPartsOfThePicture) {
  Random random(9);
  std::vector<Eigen::Vector2d> pixels = anywhere(200, random);
  for (int i = 0; i < 300; ++i)
    pixels.emplace_back(random.uniform(85, 155), random.uniform(85, 155));
  Map map = map_with(pixels, random);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double error = (i < 200 ? 1 : 1.3) * std::exp(0.05 * random.gaussian());
    map.keyframes()[map.newest()].depth.push_back(float(depth_of(map, i) / 2.5 * error));
  }
  EXPECT_NEAR(align_picture(map, map.newest()).scale / 2.5, 1, 0.03);
}

// A network that blurs depth answers with some of the mean depth everywhere.
TEST(AlignPicture, StretchesDepthThatShiesAwayFromNearAndFar) {
  Random random(10);
  Map map = map_with(anywhere(300, random), random);
  Keyframe& keyframe = map.keyframes()[map.newest()];
  double mean = 0, sum = 0, squares = 0;
  for (int i = 0; i < 300; ++i) mean += depth_of(map, i) / 2.5 / 300;
  for (int i = 0; i < 300; ++i) {
    keyframe.depth.push_back(float(mean * std::pow(depth_of(map, i) / 2.5 / mean, 0.5)));
    const double log_depth = std::log(keyframe.depth.back());
    sum += log_depth / 300;
    squares += log_depth * log_depth / 300;
  }
  keyframe.depth_range = {sum, squares - sum * sum};
  const PictureScale as_it_is = align_picture(map, map.newest());
  const PictureScale stretched = align_picture(map, map.newest(), 2);
  EXPECT_NEAR(stretched.scale / 2.5, 1, 0.01);
  EXPECT_LT(stretched.log_error, 0.02);
  EXPECT_GT(as_it_is.log_error, 0.1);
  EXPECT_NEAR(as_it_is.variance / as_it_is.covariance, 2, 0.1);
  EXPECT_NEAR(as_it_is.log_scale(2), std::log(stretched.scale), 0.02)
      << "pictures are not looked at again when more is known of the contrast";
}

TEST(StretchedDepth, KeepsThePicturesMeanInMetres) {
  Random random(11);
  std::vector<double> logs;
  for (int i = 0; i < 100000; ++i) logs.push_back(std::log(3) + 0.2 * random.gaussian());
  const DepthRange range{std::log(3), 0.04};
  const auto mean_of = [&](double contrast) {
    double mean = 0;
    for (const double l : logs) mean += stretched_depth(std::exp(l), range, contrast) / 1e5;
    return mean;
  };
  // The network has made half of a range of 0.4 from a mean of 3 exp(0.04): blur keeps means.
  EXPECT_NEAR(mean_of(2), 3 * std::exp(0.04), 0.01);
  EXPECT_NEAR(stretched_depth(3 * std::exp(0.04), range, 2), 3 * std::exp(0.04), 1e-12);
  EXPECT_EQ(stretched_depth(2.5, range, 1), 2.5);
  EXPECT_EQ(stretched_depth(2.5, {}, 2), 2.5) << "of such a picture nothing is known";
  EXPECT_EQ(stretched_depth(0, range, 2), 0);
}

}  // namespace
}  // namespace cairn
