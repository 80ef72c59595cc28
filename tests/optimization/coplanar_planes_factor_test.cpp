#include "cairn/optimization/factors/coplanar_planes_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "cairn/optimization/factors/plane_observation_factor.h"
#include "factor_check.h"
#include "factor_graph.h"
#include "geometry/planes.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Block;
using testing::expect_true_derivatives;
using testing::FactorGraph;
using testing::point_on;
using testing::Random;
using testing::random_plane;
using testing::residual;

TEST(CoplanarPlanesFactor, IsTheDistanceOfThePlaceFromTheFirstPlaneInSigmas) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_w1 = random.motion(3, 4), T_w2 = random.motion(3, 4);
    const Plane a = random_plane(random, 4), b = random_plane(random, 4);
    const Vector3d foot = point_on(b, random, 3);
    const Vector3d beside = foot + random.uniform(-1, 1) * b.normal();  // only its foot matters
    const Eigen::VectorXd e =
        residual(CoplanarPlanesFactor(PlaneFrames::kTwo, beside, 0.02),
                 {Block::of(T_w1), Block::of(a), Block::of(T_w2), Block::of(b)});
    EXPECT_NEAR(e[0], a.signed_distance(T_w1.inverse() * T_w2 * foot) / 0.02, 1e-9);
  }
}

TEST(CoplanarPlanesFactor, IsZeroForOnePlane) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_w1 = random.motion(3, 4), T_w2 = random.motion(3, 4);
    const Plane plane = random_plane(random, 4);
    const Vector3d place = random.gaussian3();
    const Eigen::VectorXd e =
        residual(CoplanarPlanesFactor(PlaneFrames::kTwo, place, 0.02),
                 {Block::of(T_w1), Block::of(plane.transformed(T_w1.inverse())), Block::of(T_w2),
                  Block::of(plane.transformed(T_w2.inverse()))});
    EXPECT_NEAR(e[0], 0, 1e-9);
  }
}

TEST(CoplanarPlanesFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Block T_w1 = Block::of(random.motion(3, 4)), T_w2 = Block::of(random.motion(3, 4));
    const Block a = Block::of(random_plane(random, 4)), b = Block::of(random_plane(random, 4));
    const Vector3d place = random.gaussian3();
    expect_true_derivatives(CoplanarPlanesFactor(PlaneFrames::kTwo, place, 0.1),
                            {T_w1, a, T_w2, b});
    expect_true_derivatives(CoplanarPlanesFactor(PlaneFrames::kOne, place, 0.1), {a, b});
  }
}

// What one picture shows of a plane; firmly.
void observe(FactorGraph& graph, const Plane& plane, double* block) {
  const PlaneMeasurement seen =
      PlaneMeasurement::isotropic(plane.normal(), -plane.offset() * plane.normal(), 0.01, 0.01);
  graph.connect(new ReferencePlaneObservationFactor(FactorForm::kRobust, seen), nullptr, block);
}

TEST(CoplanarPlanesFactor, MakesTwoLevelsOneAndBothGiveWay) {
  const Plane a(Vector3d::UnitY(), 1.5), b(Vector3d::UnitY(), 1.3);
  FactorGraph graph;
  double* block_a = graph.add(a);
  double* block_b = graph.add(b);
  observe(graph, a, block_a);
  observe(graph, b, block_b);
  graph.connect(new CoplanarPlanesFactor(PlaneFrames::kOne, {0, -1.3, 0}, 1e-4), nullptr, block_a,
                block_b);
  graph.solve();
  EXPECT_NEAR(PlaneManifold::unpack(block_a).offset(), 1.4, 1e-3);
  EXPECT_NEAR(PlaneManifold::unpack(block_b).offset(), 1.4, 1e-3);
}

TEST(CoplanarPlanesFactor, MovesTheCameraThatSawTheSecondLevelTooHigh) {
  const Plane floor(Vector3d::UnitY(), 1.5);
  const SE3 truth(Eigen::Quaterniond::Identity(), {1, 0.2, 3});
  const Plane in_camera = floor.transformed(truth.inverse());
  FactorGraph graph;
  double* camera = graph.add(SE3(truth.rotation(), truth.translation() + Vector3d(0, 0.3, 0)));
  double* second = graph.add(in_camera);
  observe(graph, in_camera, second);
  graph.connect(new CoplanarPlanesFactor(PlaneFrames::kTwo, {0, -1.7, 0}, 0.01), nullptr,
                graph.add(SE3(), true), graph.add(floor, true), camera, second);
  graph.solve();
  EXPECT_NEAR(SE3Manifold::unpack(camera).translation().y(), 0.2, 1e-6);
}

}  // namespace
}  // namespace cairn
