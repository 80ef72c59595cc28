#include "quick_scene/quick_scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

bool same_bytes(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(QuickScene, SameSeedSameBytesWithAnyNumberOfThreads) {
  const cv::Mat first = QuickScene(3).render(1.5);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(same_bytes(first, QuickScene(3).render(1.5)));
  EXPECT_FALSE(same_bytes(first, QuickScene(4).render(1.5)));
}

TEST(QuickScene, PathIsSmoothAndLeavesRoomForParallax) {
  const QuickScene scene(0);
  Eigen::AlignedBox3d space;
  for (int i = 0; i < 300; ++i) {
    const double t = i / 30.0;
    const SE3 step = scene.T_wc(t).inverse() * scene.T_wc(t + 1.0 / 30);
    EXPECT_LT(step.translation().norm(), 0.04);
    EXPECT_LT(so3_log(step.rotation()).norm(), 0.04);
    space.extend(scene.T_wc(t).translation());
  }
  EXPECT_GT(space.diagonal().norm(), 1.0);
  EXPECT_LT(space.diagonal().norm(), 3.0);
}

TEST(QuickScene, EveryRayOfThePictureMeetsASurface) {
  const QuickScene scene(0);
  int missed = 0, all = 0;
  for (int i = 0; i < 36; ++i) {
    const SE3 T_wc = scene.T_wc(1.7 * i);
    for (int y = 0; y < 480; y += 40) {
      for (int x = 0; x < 640; x += 40, ++all) {
        const Eigen::Vector3d ray = T_wc.rotation() * scene.camera().unproject({x, y});
        const auto depth = scene.cast(T_wc.translation(), ray);
        missed += !depth;
        EXPECT_GT(depth.value_or(1), 0.3);
      }
    }
  }
  EXPECT_LT(missed, all / 50);
}

// A surface point looks alike from two places: the pictures, the poses and the depths agree.
TEST(QuickScene, DepthAndPoseAreThoseOfThePictures) {
  const QuickScene scene(1, {.noise = 0, .vignetting = 0});
  const SE3 T_wa = scene.T_wc(2.0), T_wb = scene.T_wc(2.2);
  EXPECT_GT((T_wa.translation() - T_wb.translation()).norm(), 0.02);
  cv::Mat a, b;
  cv::GaussianBlur(scene.render(2.0), a, {5, 5}, 1.5);
  cv::GaussianBlur(scene.render(2.2), b, {5, 5}, 1.5);
  std::vector<cv::Vec3b> colours;  // in a
  cv::Mat at_b(0, 1, CV_32FC2);    // where the same points are in b
  for (int y = 20; y < 460; y += 9) {
    for (int x = 20; x < 620; x += 9) {
      const Eigen::Vector3d ray = T_wa.rotation() * scene.camera().unproject({x, y});
      const auto depth = scene.cast(T_wa.translation(), ray);
      if (!depth) continue;
      const Eigen::Vector3d X_w = T_wa.translation() + *depth * ray;
      const Eigen::Vector2d pixel = scene.camera().project(T_wb.inverse() * X_w);
      if (pixel.minCoeff() < 10 || pixel.x() > 620 || pixel.y() > 460) continue;
      const auto from_b = scene.cast(T_wb.translation(), X_w - T_wb.translation());
      if (!from_b || std::abs(*from_b - 1) > 1e-3) continue;  // hidden from there
      colours.push_back(a.at<cv::Vec3b>(y, x));
      at_b.push_back(cv::Vec2f(float(pixel.x()), float(pixel.y())));
    }
  }
  ASSERT_GT(colours.size(), 1000u);
  auto mean_difference = [&](const cv::Scalar& displacement) {
    cv::Mat there;
    cv::remap(b, there, at_b + displacement, {}, cv::INTER_LINEAR);
    return cv::norm(there, cv::Mat(colours), cv::NORM_L1) / (3 * double(colours.size()));
  };
  EXPECT_LT(mean_difference({0, 0}), 5);
  EXPECT_GT(mean_difference({4, 0}), 3 * mean_difference({0, 0}));
}

}  // namespace
}  // namespace cairn
