#include "cairn/optimization/factors/lens_point_factor.h"

#include <gtest/gtest.h>

#include "cairn/optimization/factors/point_factor.h"
#include "cairn/optimization/se3_manifold.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using testing::kCamera;
using testing::Random;
constexpr int kLens = LensCorrection::kSize;
using Lens = Eigen::Matrix<double, kLens, 1>;

Eigen::Vector2d residual(const ceres::CostFunction& factor, const SE3& T_wc,
                         const Eigen::Vector3d& X_w, const Lens& lens) {
  double pose[7];
  SE3Manifold::pack(T_wc, pose);
  const double* blocks[] = {pose, X_w.data(), lens.data()};
  Eigen::Vector2d e;
  EXPECT_TRUE(factor.Evaluate(blocks, e.data(), nullptr));
  return e;
}

Lens random_lens(Random& random) {
  Lens lens;
  for (int i = 0; i < 3; ++i) lens[i] = random.uniform(-0.05, 0.05);
  for (int i = 3; i < 5; ++i) lens[i] = random.uniform(-10, 10);
  return lens;
}

TEST(LensPointFactor, WithoutACorrectionItIsThePointFactor) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const SE3 T_wc = random.motion(3, 2);
    const Eigen::Vector3d X_w =
        T_wc * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 3);
    const Eigen::Vector2d pixel(random.uniform(0, 640), random.uniform(0, 480));
    const LensPointFactor with(kCamera, pixel, 1.5);
    const PointFactor without(kCamera, pixel, 1.5);
    const Lens none = Lens::Zero();
    const Eigen::Vector2d difference =
        residual(with, T_wc, X_w, none) - residual(without, T_wc, X_w, none);
    EXPECT_LT(difference.norm(), 1e-9);
  }
}

TEST(LensPointFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T_wc = random.motion(3.1, random.uniform(0, 5));
    const Eigen::Vector3d X_w =
        T_wc *
        Eigen::Vector3d(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(1, 8));
    const Lens lens = random_lens(random);
    const LensPointFactor factor(kCamera, {random.uniform(0, 640), random.uniform(0, 480)},
                                 random.uniform(0.5, 4));
    double pose[7];
    SE3Manifold::pack(T_wc, pose);
    const double* blocks[] = {pose, X_w.data(), lens.data()};
    Eigen::Vector2d e;
    Eigen::Matrix<double, 2, 7, Eigen::RowMajor> J_pose;
    Eigen::Matrix<double, 2, 3, Eigen::RowMajor> J_point;
    Eigen::Matrix<double, 2, kLens, Eigen::RowMajor> J_lens;
    double* jacobians[] = {J_pose.data(), J_point.data(), J_lens.data()};
    ASSERT_TRUE(factor.Evaluate(blocks, e.data(), jacobians));

    constexpr double h = 1e-6;
    auto slope = [&](auto&& at) -> Eigen::Vector2d { return (at(h) - at(-h)) / (2 * h); };
    Eigen::Matrix<double, 2, 6> numeric_pose;
    for (int k = 0; k < 6; ++k) {
      numeric_pose.col(k) = slope([&](double step) {
        return residual(factor, T_wc * SE3::exp(step * Vector6d::Unit(k)), X_w, lens);
      });
    }
    Eigen::Matrix<double, 2, 3> numeric_point;
    for (int k = 0; k < 3; ++k) {
      numeric_point.col(k) = slope([&](double step) {
        return residual(factor, T_wc, X_w + step * Eigen::Vector3d::Unit(k), lens);
      });
    }
    Eigen::Matrix<double, 2, kLens> numeric_lens;
    for (int k = 0; k < kLens; ++k) {
      numeric_lens.col(k) = slope(
          [&](double step) { return residual(factor, T_wc, X_w, lens + step * Lens::Unit(k)); });
    }
    EXPECT_LT((J_pose.leftCols<6>() - numeric_pose).norm(), 1e-6 * numeric_pose.norm());
    EXPECT_LT((J_point - numeric_point).norm(), 1e-6 * numeric_point.norm());
    EXPECT_LT((J_lens - numeric_lens).norm(), 1e-6 * numeric_lens.norm());
    EXPECT_EQ(J_pose.col(6).norm(), 0);
  }
}

TEST(LensPriorFactor, IsTheCorrectionInSigmas) {
  const LensPriorFactor prior({0.02, 0.1, 0.2, 5, 10});
  const double values[kLens] = {0.02, -0.1, 0.4, 10, 0};
  const double* blocks[] = {values};
  Lens e;
  Eigen::Matrix<double, kLens, kLens, Eigen::RowMajor> J;
  double* jacobians[] = {J.data()};
  ASSERT_TRUE(prior.Evaluate(blocks, e.data(), jacobians));
  EXPECT_LT((e - (Lens() << 1, -1, 2, 2, 0).finished()).norm(), 1e-12);
  EXPECT_LT((J * Eigen::Map<const Lens>(values) - e).norm(), 1e-12);
}

}  // namespace
}  // namespace cairn
