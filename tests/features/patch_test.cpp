#include "cairn/features/patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "textures.h"

namespace cairn {
namespace {

// A smooth texture that can be asked for at any place.
double texture(const Eigen::Vector2d& p) {
  return 128 + 40 * std::sin(0.55 * p.x() + 0.2 * p.y()) +
         35 * std::cos(0.6 * p.y() - 0.15 * p.x()) +
         20 * std::sin(0.31 * p.x() * 0.9 - 0.4 * p.y() + 1);
}

// The texture through a map from pixels to its places.
template <class Warp>
cv::Mat picture_of(const Warp& warp, double contrast = 1, double brightness = 0) {
  cv::Mat picture(60, 60, CV_8UC1);
  for (int r = 0; r < picture.rows; ++r) {
    for (int c = 0; c < picture.cols; ++c) {
      const double grey =
          contrast * (texture(warp(Eigen::Vector2d(c, r))) - 128) + 128 + brightness;
      picture.at<std::uint8_t>(r, c) = cv::saturate_cast<std::uint8_t>(grey);
    }
  }
  return picture;
}

const Eigen::Vector2f kHere(30.3F, 29.6F);

Patch patch_of_texture() {
  return Patch::cut(picture_of([](const Eigen::Vector2d& p) { return p; }), kHere).value();
}

TEST(Patch, IsFoundAgainToAFractionOfAPixel) {
  const Patch patch = patch_of_texture();
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.4, -0.7),
                                       Eigen::Vector2d(-1.2, 0.9), Eigen::Vector2d(1.1, 1.3)}) {
    const cv::Mat picture =
        picture_of([&](const Eigen::Vector2d& p) -> Eigen::Vector2d { return p - shift; });
    const auto found = patch.find(picture, kHere, Patch::Warp(), 2.5F);
    ASSERT_TRUE(found) << shift.transpose();
    EXPECT_LT((*found - kHere - shift.cast<float>()).norm(), 0.05) << shift.transpose();
  }
}

TEST(Patch, IsFoundTurnedAndLargerAndInOtherLight) {
  const Patch patch = patch_of_texture();
  const Eigen::Matrix2d A = 1.2 * Eigen::Rotation2Dd(0.4).toRotationMatrix();
  const Eigen::Vector2d there(28.4, 31.2);
  const cv::Mat picture = picture_of(
      [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
        return kHere.cast<double>() + A.inverse() * (p - there);
      },
      0.6, 25);
  const Eigen::Vector2f start = there.cast<float>() + Eigen::Vector2f(0.8F, -0.6F);
  const auto found = patch.find(picture, start, {.affine = A.cast<float>()}, 2.5F);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - there.cast<float>()).norm(), 0.08);
}

TEST(Patch, IsFoundOnASurfaceThatGoesAwayFromTheCamera) {
  const Patch patch = patch_of_texture();
  const Eigen::Vector2d there(28.4, 31.2), foreshortening(0.05, -0.03);
  const Eigen::Matrix2d A = Eigen::Vector2d(1.3, 0.9).asDiagonal();
  const cv::Mat picture = picture_of([&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    const Eigen::Vector2d v = A.inverse() * (p - there);
    return kHere.cast<double>() + v / (1 - foreshortening.dot(v));
  });
  const auto off = [&](const Patch::Warp& warp) {
    const auto found = patch.find(picture, there.cast<float>(), warp, 2.5F);
    return found ? (*found - there.cast<float>()).norm() : 10;
  };
  EXPECT_LT(off({A.cast<float>(), foreshortening.cast<float>()}), 0.05);
  EXPECT_GT(off({.affine = A.cast<float>()}), 0.1);
}

TEST(Patch, IsNotFoundWhereThePictureLooksOtherwise) {
  const Patch patch = patch_of_texture();
  int found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const cv::Mat other = random_texture({60, 60}, seed);
    found += patch.find(other, kHere, Patch::Warp(), 2.5F).has_value();
  }
  EXPECT_LE(found, 1);
  const cv::Mat blank(60, 60, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(patch.find(blank, kHere, Patch::Warp(), 2.5F));
}

TEST(Patch, StaysWithinReachAndWithinThePicture) {
  const Patch patch = patch_of_texture();
  const cv::Mat picture = picture_of(
      [](const Eigen::Vector2d& p) -> Eigen::Vector2d { return p - Eigen::Vector2d(1.5, 0); });
  EXPECT_TRUE(patch.find(picture, kHere, Patch::Warp(), 2.0F));
  EXPECT_FALSE(patch.find(picture, kHere, Patch::Warp(), 1.0F));
  for (const Eigen::Vector2f& edge : {Eigen::Vector2f(2, 30), Eigen::Vector2f(58, 30),
                                      Eigen::Vector2f(30, 1), Eigen::Vector2f(-5, 70)}) {
    EXPECT_FALSE(patch.find(picture, edge, Patch::Warp(), 2.5F));
    EXPECT_FALSE(Patch::cut(picture, edge));
  }
}

TEST(Patch, OfOneGreyHasNoPlace) {
  const cv::Mat blank(60, 60, CV_8UC1, cv::Scalar(90));
  const Patch patch = Patch::cut(blank, kHere).value();
  EXPECT_FALSE(patch.find(blank, kHere, Patch::Warp(), 2.5F));
}

}  // namespace
}  // namespace cairn
