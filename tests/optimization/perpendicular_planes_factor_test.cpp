#include "cairn/optimization/factors/perpendicular_planes_factor.h"

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
using testing::Random;
using testing::random_plane;
using testing::residual;

constexpr double kDegree = M_PI / 180;

TEST(PerpendicularPlanesFactor, IsTheCosineInSigmas) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_w1 = random.motion(3, 4), T_w2 = random.motion(3, 4);
    const Plane a_w = random_plane(random, 4), b_w = random_plane(random, 4);
    const Eigen::VectorXd e =
        residual(PerpendicularPlanesFactor(PlaneFrames::kTwo, 0.02),
                 {Block::of(T_w1), Block::of(a_w.transformed(T_w1.inverse())), Block::of(T_w2),
                  Block::of(b_w.transformed(T_w2.inverse()))});
    EXPECT_NEAR(e[0], a_w.normal().dot(b_w.normal()) / 0.02, 1e-9);
  }
}

TEST(PerpendicularPlanesFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Block T_w1 = Block::of(random.motion(3, 4)), T_w2 = Block::of(random.motion(3, 4));
    const Block a = Block::of(random_plane(random, 4)), b = Block::of(random_plane(random, 4));
    expect_true_derivatives(PerpendicularPlanesFactor(PlaneFrames::kTwo, 0.1), {T_w1, a, T_w2, b});
    expect_true_derivatives(PerpendicularPlanesFactor(PlaneFrames::kOne, 0.1), {a, b});
  }
}

TEST(PerpendicularPlanesFactor, MakesTwoNearlyPerpendicularPlanesPerpendicular) {
  Random random(3);
  for (const PlaneFrames frames : {PlaneFrames::kOne, PlaneFrames::kTwo}) {
    for (const double angle : {80 * kDegree, 97 * kDegree}) {
      const Plane a = random_plane(random, 4);
      const Vector3d axis = tangent_axes(a.normal()).col(0);
      const Plane b_w(so3_exp(angle * axis) * a.normal(), 1.5);
      const SE3 T_w2 = frames == PlaneFrames::kTwo ? random.motion(1, 2) : SE3();
      const Plane b = b_w.transformed(T_w2.inverse());
      FactorGraph graph;  // the first keyframe is the world
      double* block_a = graph.add(a);
      double* block_b = graph.add(b);
      for (const auto& [plane, block] : {std::pair(a, block_a), std::pair(b, block_b)}) {
        const PlaneMeasurement seen = PlaneMeasurement::isotropic(
            plane.normal(), -plane.offset() * plane.normal(), 0.1, 0.01);
        graph.connect(new ReferencePlaneObservationFactor(FactorForm::kRobust, seen), nullptr,
                      block);
      }
      auto* factor = new PerpendicularPlanesFactor(frames, 1e-4);
      if (frames == PlaneFrames::kTwo) {
        graph.connect(factor, nullptr, graph.add(SE3(), true), block_a, graph.add(T_w2, true),
                      block_b);
      } else {
        graph.connect(factor, nullptr, block_a, block_b);
      }
      graph.solve();
      const Plane end_a = PlaneManifold::unpack(block_a), end_b = PlaneManifold::unpack(block_b);
      const double moved = std::abs(90 * kDegree - angle) / 2;
      EXPECT_NEAR(angle_between(end_a, end_b.transformed(T_w2)), 90 * kDegree, 0.01 * kDegree);
      EXPECT_NEAR(angle_between(end_a, a), moved, 0.1 * kDegree) << "both give way";
      EXPECT_NEAR(angle_between(end_b, b), moved, 0.1 * kDegree);
    }
  }
}

}  // namespace
}  // namespace cairn
