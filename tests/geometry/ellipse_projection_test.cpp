#include "cairn/geometry/ellipse_projection.h"

#include <gtest/gtest.h>

#include "scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::kCamera;
using testing::Random;

// Anywhere in front of the camera, also beside the picture; its depth is more than its size.
Ellipsoid random_ellipsoid(Random& random) {
  Ellipsoid e;
  for (double& axis : e.semi_axes) axis = 0.3 * std::exp(random.uniform(-1, 1));
  const SE3 turned = random.motion(M_PI, 0);
  const double x = random.uniform(-2, 2), y = random.uniform(-2, 2), z = random.uniform(1, 6);
  e.T = SE3(turned.rotation(), {x, y, z});
  return e;
}

Ellipsoid moved(const Ellipsoid& e, int direction, double length) {
  Eigen::Matrix<double, 9, 1> step = Eigen::Matrix<double, 9, 1>::Zero();
  step[direction] = length;
  return {e.T * SE3::exp(step.head<6>()), e.semi_axes.array() * step.tail<3>().array().exp()};
}

TEST(ProjectedBox, TouchesTheOutlineOnAllSides) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    const auto box = projected_box(kCamera, e);
    ASSERT_TRUE(box);
    const auto outline = projected_outline(kCamera, e, 20'000);
    ASSERT_EQ(outline.size(), 20'000u);
    Eigen::Vector2d low = outline[0], high = outline[0];
    for (const auto& pixel : outline) {
      low = low.cwiseMin(pixel);
      high = high.cwiseMax(pixel);
    }
    EXPECT_NEAR(box->x0, low.x(), 0.01);
    EXPECT_NEAR(box->y0, low.y(), 0.01);
    EXPECT_NEAR(box->x1, high.x(), 0.01);
    EXPECT_NEAR(box->y1, high.y(), 0.01);
  }
}

TEST(ProjectedOutline, IsWhereViewingRaysTouch) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    for (const auto& pixel : projected_outline(kCamera, e, 30)) {
      // Where the ellipsoid is the unit ball, the ray passes the origin at a distance of 1.
      const SE3 T = e.T.inverse();
      const Vector3d from = T.translation().cwiseQuotient(e.semi_axes);
      const Vector3d along = (T.rotation() * kCamera.unproject(pixel)).cwiseQuotient(e.semi_axes);
      EXPECT_NEAR(from.cross(along).norm() / along.norm(), 1, 1e-6);
    }
  }
}

TEST(ProjectedBox, HoldsThePicturesOfAllPointsInside) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    const auto box = projected_box(kCamera, e);
    ASSERT_TRUE(box);
    for (int i = 0; i < 50; ++i) {
      const Vector3d X = e.T * (0.999 * e.semi_axes.cwiseProduct(random.direction()));
      EXPECT_TRUE(box->contains(kCamera.project(X)));
    }
  }
}

TEST(ProjectedBox, HasTheDerivativeOfCentralDifferences) {
  Random random(4);
  constexpr double h = 1e-6;
  for (int trial = 0; trial < 50; ++trial) {
    const Ellipsoid e = random_ellipsoid(random);
    BoxByEllipsoid analytic, numeric;
    const auto box = projected_box(kCamera, e, &analytic);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->edges(), projected_box(kCamera, e)->edges());
    for (int k = 0; k < 9; ++k) {
      const auto ahead = projected_box(kCamera, moved(e, k, h));
      const auto behind = projected_box(kCamera, moved(e, k, -h));
      ASSERT_TRUE(ahead && behind);
      numeric.col(k) = (ahead->edges() - behind->edges()) / (2 * h);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-5 * (1 + numeric.norm()))
        << "analytic:\n"
        << analytic << "\nnumeric:\n"
        << numeric;
  }
}

TEST(ProjectedBox, IsThatOfABallAheadOfTheCamera) {
  const Ellipsoid ball{SE3(Eigen::Quaterniond::Identity(), {0, 0, 2}), Vector3d::Constant(0.5)};
  const double tangent = 0.5 / std::sqrt(2 * 2 - 0.5 * 0.5);
  const auto box = projected_box(kCamera, ball);
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->x0, kCamera.cx - kCamera.fx * tangent, 1e-9);
  EXPECT_NEAR(box->x1, kCamera.cx + kCamera.fx * tangent, 1e-9);
  EXPECT_NEAR(box->y0, kCamera.cy - kCamera.fy * tangent, 1e-9);
  EXPECT_NEAR(box->y1, kCamera.cy + kCamera.fy * tangent, 1e-9);
}

TEST(ProjectedBox, IsNoneBehindTheCameraOrAcrossItsPlane) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Ellipsoid e = random_ellipsoid(random);
    const Vector3d front = e.centre();
    const double reach = (e.T.matrix3().row(2) * e.semi_axes.asDiagonal()).norm();  // along z
    for (const double z : {-front.z() - reach, -reach * 1.01, -0.5 * reach, 0.0, 0.99 * reach}) {
      e.T = SE3(e.T.rotation(), {front.x(), front.y(), z});
      EXPECT_FALSE(projected_box(kCamera, e));
      EXPECT_TRUE(projected_outline(kCamera, e, 10).empty());
    }
    e.T = SE3(e.T.rotation(), {front.x(), front.y(), 1.01 * reach});
    EXPECT_TRUE(projected_box(kCamera, e));
    e.semi_axes.x() = std::nan("");
    EXPECT_FALSE(projected_box(kCamera, e));
  }
}

}  // namespace
}  // namespace cairn
