#include "cairn/optimization/factors/point_factor.h"

#include <gtest/gtest.h>

#include "cairn/optimization/se3_manifold.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;
using RowMajor27 = Eigen::Matrix<double, 2, 7, Eigen::RowMajor>;
using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;

Eigen::Vector2d residual(const PointFactor& factor, const SE3& T_wc, const Eigen::Vector3d& X_w) {
  double pose[7];
  SE3Manifold::pack(T_wc, pose);
  const double* blocks[] = {pose, X_w.data()};
  Eigen::Vector2d e;
  EXPECT_TRUE(factor.Evaluate(blocks, e.data(), nullptr));
  return e;
}

TEST(PointFactor, ResidualIsTheReprojectionErrorInSigmas) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const SE3 T_wc = random.motion(3, 2);
    const Eigen::Vector3d X_c(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 5));
    const Eigen::Vector2d pixel(random.uniform(0, 640), random.uniform(0, 480));
    const double sigma = random.uniform(0.5, 4);
    const PointFactor factor(kCamera, pixel, sigma);
    const Eigen::Vector2d expected = (kCamera.project(X_c) - pixel) / sigma;
    EXPECT_LT((residual(factor, T_wc, T_wc * X_c) - expected).norm(), 1e-7);
  }
}

TEST(PointFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T_wc = random.motion(3.1, random.uniform(0, 5));
    const Eigen::Vector3d X_c(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0.5, 8));
    const Eigen::Vector3d X_w = T_wc * X_c;
    const Eigen::Vector2d pixel(random.uniform(0, 640), random.uniform(0, 480));
    const PointFactor factor(kCamera, pixel, random.uniform(0.5, 4));

    double pose[7];
    SE3Manifold::pack(T_wc, pose);
    const double* blocks[] = {pose, X_w.data()};
    Eigen::Vector2d e;
    RowMajor27 J_pose;
    RowMajor23 J_point;
    double* jacobians[] = {J_pose.data(), J_point.data()};
    ASSERT_TRUE(factor.Evaluate(blocks, e.data(), jacobians));

    constexpr double h = 1e-6;
    Eigen::Matrix<double, 2, 6> numeric_pose;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = h * Vector6d::Unit(k);
      numeric_pose.col(k) = (residual(factor, T_wc * SE3::exp(step), X_w) -
                             residual(factor, T_wc * SE3::exp(-step), X_w)) /
                            (2 * h);
    }
    Eigen::Matrix<double, 2, 3> numeric_point;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
      numeric_point.col(k) =
          (residual(factor, T_wc, X_w + step) - residual(factor, T_wc, X_w - step)) / (2 * h);
    }
    EXPECT_LT((J_pose.leftCols<6>() - numeric_pose).norm(), 1e-6 * numeric_pose.norm());
    EXPECT_LT((J_point - numeric_point).norm(), 1e-6 * numeric_point.norm());
    EXPECT_EQ(J_pose.col(6).norm(), 0) << "the seventh column belongs to no direction";
  }
}

TEST(PointFactor, BehindTheCameraItStaysFiniteAndLarge) {
  const PointFactor factor(kCamera, {320, 240}, 1);
  for (const Eigen::Vector3d& X : {Eigen::Vector3d(0.5, 0.2, -1), Eigen::Vector3d(0.5, 0.2, 0)}) {
    const Eigen::Vector2d e = residual(factor, SE3(), X);
    EXPECT_TRUE(e.allFinite());
    EXPECT_GT(e.norm(), 1000);
  }
}

}  // namespace
}  // namespace cairn
