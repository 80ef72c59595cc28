#include "cairn/optimization/factors/point_on_plane_factor.h"

#include <ceres/normal_prior.h>
#include <gtest/gtest.h>

#include "cairn/geometry/plane_fit.h"
#include "factor_check.h"
#include "factor_graph.h"
#include "geometry/planes.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Block;
using testing::expect_true_derivatives;
using testing::FactorGraph;
using testing::IsNearPlane;
using testing::point_on;
using testing::Random;
using testing::random_plane;
using testing::residual;

TEST(PointOnPlaneFactor, IsTheSignedDistanceInSigmas) {
  Random random(1);
  for (int trial = 0; trial < 30; ++trial) {
    const SE3 T_wr = random.motion(3, 4);
    const Plane plane_r = random_plane(random, 5);
    const Vector3d X_w = random.gaussian3();
    const Eigen::VectorXd e =
        residual(PointOnPlaneFactor(0.05), {Block::of(T_wr), Block::of(plane_r), Block::of(X_w)});
    EXPECT_NEAR(e[0], plane_r.transformed(T_wr).signed_distance(X_w) / 0.05, 1e-10);
  }
}

TEST(PointOnPlaneFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 T_wr = random.motion(3.1, random.uniform(0, 5));
    const Vector3d X_w = 3 * random.gaussian3();
    expect_true_derivatives(PointOnPlaneFactor(random.uniform(0.01, 1)),
                            {Block::of(T_wr), Block::of(random_plane(random, 5)), Block::of(X_w)});
  }
}

TEST(PointOnPlaneFactor, PullsPointsOnThePlane) {
  Random random(3);
  const SE3 T_wr = random.motion(1, 2);
  const Plane plane_w = random_plane(random, 4);
  FactorGraph graph;
  double* frame = graph.add(T_wr, true);
  double* plane = graph.add(plane_w.transformed(T_wr.inverse()), true);
  std::vector<Vector3d> starts;
  std::vector<double*> points;
  for (int i = 0; i < 20; ++i) {
    starts.push_back(point_on(plane_w, random, 3) + 0.2 * random.gaussian3());
    points.push_back(graph.add(starts.back()));
    graph.connect(new PointOnPlaneFactor(1e-4), nullptr, frame, plane, points.back());
    graph.connect(new ceres::NormalPrior(Eigen::Matrix3d::Identity(), starts.back()), nullptr,
                  points.back());
  }
  graph.solve();
  for (int i = 0; i < 20; ++i) {
    const Vector3d moved = Vector3d(points[i]) - starts[i];  // a loose prior keeps them there
    EXPECT_NEAR(plane_w.signed_distance(Vector3d(points[i])), 0, 1e-6);
    EXPECT_LT(moved.cross(plane_w.normal()).norm(), 1e-6) << "along the normal only";
  }
}

TEST(PointOnPlaneFactor, PullsThePlaneToWhereItsPointsAre) {
  Random random(4);
  const Plane plane_w = random_plane(random, 4);
  const SE3 T_wr = random.motion(1, 2);
  std::vector<Vector3d> points;
  FactorGraph graph;
  double* frame = graph.add(T_wr, true);
  double* plane = graph.add(plane_w.transformed(T_wr.inverse()).exp(0.2 * random.direction()));
  for (int i = 0; i < 50; ++i) {
    points.push_back(point_on(plane_w, random, 2) + 0.02 * random.gaussian() * plane_w.normal());
    graph.connect(new PointOnPlaneFactor(0.02), nullptr, frame, plane,
                  graph.add(points.back(), true));
  }
  graph.solve();
  const Plane found_w = PlaneManifold::unpack(plane).transformed(T_wr);
  EXPECT_THAT(found_w, IsNearPlane(fit_plane(points).plane, 1e-4, 1e-5)) << "least squares";
  EXPECT_THAT(found_w, IsNearPlane(plane_w, 0.5, 0.03));
}

TEST(PointOnPlaneFactor, MovesAKeyframeToWhereItsPlaneFits) {
  Random random(5);
  const Plane plane_w = random_plane(random, 4);
  const SE3 T_wr = random.motion(1, 2);
  FactorGraph graph;
  double* frame = graph.add(T_wr * random.motion(0.2, 0.3));
  double* plane = graph.add(plane_w.transformed(T_wr.inverse()), true);
  for (int i = 0; i < 20; ++i) {
    graph.connect(new PointOnPlaneFactor(0.02), nullptr, frame, plane,
                  graph.add(point_on(plane_w, random, 2), true));
  }
  graph.solve();
  EXPECT_THAT(PlaneManifold::unpack(plane).transformed(SE3Manifold::unpack(frame)),
              IsNearPlane(plane_w, 1e-4, 1e-5));
}

}  // namespace
}  // namespace cairn
