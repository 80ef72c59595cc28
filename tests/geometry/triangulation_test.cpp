#include "cairn/geometry/triangulation.h"

#include <gmock/gmock.h>

#include <limits>

#include "geometry/scene.h"

namespace cairn {
namespace {

using Cause = Triangulation::Cause;
using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::kCamera;
using testing::Random;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Cameras side by side that look at a point.
std::vector<TriangulationView> views_of(const Vector3d& X, int count, double step) {
  std::vector<TriangulationView> views;
  for (int i = 0; i < count; ++i) {
    TriangulationView view;
    view.T_cw = SE3(so3_exp({0.01 * i, -0.02 * i, 0.005}), Vector3d(-step * i, 0.01 * i, 0));
    view.pixel = kCamera.project(view.T_cw * X);
    views.push_back(view);
  }
  return views;
}

TEST(TwoRays, MeetInTheExactPoint) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const SE3 T_21 = random.motion(0.5, 0.7);
    const Vector3d X(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(2, 9));
    const Vector3d X2 = T_21 * X;
    const TwoRayPoint p = triangulate_two_rays(T_21, X * 3, X2.normalized());
    EXPECT_TRUE(p.in_front());
    EXPECT_LT((p.point - X).norm(), 1e-9);
    EXPECT_NEAR(p.depth1, X.norm(), 1e-9);
    EXPECT_NEAR(p.depth2, X2.norm(), 1e-9);
    EXPECT_NEAR(std::cos(p.parallax), (T_21.rotation() * X).normalized().dot(X2.normalized()),
                1e-9);
  }
}

TEST(TwoRays, MinimiseTheAngularError) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_21 = random.motion(0.3, 1);
    const Vector3d X(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(3, 6));
    const Vector3d ray1 = (X.normalized() + 0.003 * random.gaussian3()).normalized();
    const Vector3d ray2 = ((T_21 * X).normalized() + 0.003 * random.gaussian3()).normalized();
    const auto cost = [&](const Vector3d& P) {
      return ray1.cross(P.normalized()).squaredNorm() +
             ray2.cross((T_21 * P).normalized()).squaredNorm();
    };
    const Vector3d best = triangulate_two_rays(T_21, ray1, ray2).point;
    for (int i = 0; i < 20; ++i) {
      EXPECT_GE(cost(best + 0.01 * random.gaussian3()), cost(best) - 1e-12);
    }
  }
}

TEST(TwoRays, ThatDivergeMeetBehindTheCameras) {
  const SE3 T_21(Eigen::Quaterniond::Identity(), Vector3d(-1, 0, 0));
  EXPECT_FALSE(triangulate_two_rays(T_21, Vector3d(-0.1, 0, 1), Vector3d(0.1, 0, 1)).in_front());
  EXPECT_FALSE(triangulate_two_rays(T_21, Vector3d(0, 0, 1), Vector3d(0, 0, 1)).in_front());
  EXPECT_FALSE(triangulate_two_rays(SE3(), Vector3d(0, 0, 1), Vector3d(0.1, 0, 1)).in_front());
  EXPECT_FALSE(triangulate_two_rays(T_21, Vector3d(kNaN, 0, 1), Vector3d(0, 0, 1)).in_front());
}

TEST(Triangulate, FindsTheExactPointFromManyViews) {
  Random random(3);
  for (int count = 2; count < 8; ++count) {
    const Vector3d X(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 8));
    const Triangulation result = triangulate(views_of(X, count, 0.3), kCamera);
    EXPECT_TRUE(result.usable()) << describe(result.cause);
    EXPECT_LT((result.point - X).norm(), 1e-7);
    EXPECT_LT(result.max_error_sigmas, 1e-6);
  }
}

TEST(Triangulate, DoesNotMindAWorldThatIsFarAway) {
  const SE3 T_wv(so3_exp({0.3, 0.2, 1}), Vector3d(1e5, -2e5, 3e4));
  std::vector<TriangulationView> views = views_of({0.2, 0.1, 4}, 4, 0.3);
  for (TriangulationView& view : views) view.T_cw = view.T_cw * T_wv.inverse();
  const Triangulation result = triangulate(views, kCamera);
  ASSERT_TRUE(result.usable()) << describe(result.cause);
  EXPECT_LT((T_wv.inverse() * result.point - Vector3d(0.2, 0.1, 4)).norm(), 1e-5);
}

TEST(Triangulate, MinimisesTheReprojectionError) {
  Random random(4);
  for (int trial = 0; trial < 30; ++trial) {
    const Vector3d X(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 6));
    std::vector<TriangulationView> views = views_of(X, 5, 0.2);
    for (TriangulationView& view : views) {
      view.sigma_px = random.uniform(0.5, 2);
      view.pixel += view.sigma_px * 0.5 * random.gaussian3().head<2>();
    }
    const auto cost = [&](const Vector3d& P) {
      double sum = 0;
      for (const TriangulationView& view : views) {
        sum += ((kCamera.project(view.T_cw * P) - view.pixel) / view.sigma_px).squaredNorm();
      }
      return sum;
    };
    const Triangulation result = triangulate(views, kCamera);
    for (int i = 0; i < 20; ++i) {
      EXPECT_GE(cost(result.point + 0.001 * random.gaussian3()), cost(result.point));
    }
  }
}

TEST(Triangulate, SaysWhyThereIsNoPoint) {
  const std::vector<TriangulationView> good = views_of({0.2, 0.1, 4}, 3, 0.3);
  EXPECT_EQ(triangulate({good.data(), 1}, kCamera).cause, Cause::kTooFewViews);
  EXPECT_EQ(triangulate(views_of({0.2, 0.1, 900}, 3, 0.3), kCamera).cause, Cause::kSmallParallax);
  EXPECT_EQ(triangulate(views_of({0.2, 0.1, -4}, 3, 0.3), kCamera).cause, Cause::kBehindCamera);
  std::vector<TriangulationView> bad = good;
  bad[1].pixel.y() += 40;
  EXPECT_EQ(triangulate(bad, kCamera).cause, Cause::kLargeError);
  bad[1].pixel.y() = kNaN;
  EXPECT_EQ(triangulate(bad, kCamera).cause, Cause::kNotFinite);
  const std::vector<TriangulationView> same(3, good[0]);
  EXPECT_FALSE(triangulate(same, kCamera).usable());
}

}  // namespace
}  // namespace cairn
