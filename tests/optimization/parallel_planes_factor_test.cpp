#include "cairn/optimization/factors/parallel_planes_factor.h"

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

constexpr FactorForm kForms[] = {FactorForm::kPaper, FactorForm::kRobust};
constexpr double kDegree = M_PI / 180;

// Another plane whose normal makes this angle with that of the first.
Plane tilted(const Plane& plane, double angle, Random& random) {
  const double a = random.uniform(0, 2 * M_PI);
  const Vector3d axis = tangent_axes(plane.normal()) * Eigen::Vector2d(std::cos(a), std::sin(a));
  return Plane(so3_exp(angle * axis) * plane.normal(), random.uniform(-4, 4));
}

TEST(ParallelPlanesFactor, ResidualsAreThoseOfTheAngle) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T_w1 = random.motion(3, 4), T_w2 = random.motion(3, 4);
    const Plane a_w = random_plane(random, 4);
    const double angle = random.uniform(0, 1.5);
    const Plane b_w = tilted(a_w, angle, random);
    const Block a = Block::of(a_w.transformed(T_w1.inverse()));
    for (const Plane& same_w : {b_w, b_w.flipped()}) {
      const Block b = Block::of(same_w.transformed(T_w2.inverse()));
      const auto value = [&](FactorForm form) {
        return residual(ParallelPlanesFactor(form, PlaneFrames::kTwo, 0.02),
                        {Block::of(T_w1), a, Block::of(T_w2), b});
      };
      EXPECT_NEAR(value(FactorForm::kPaper)[0], (std::cos(angle) - 1) / 0.02, 1e-9);
      EXPECT_NEAR(value(FactorForm::kRobust).norm(), std::sin(angle) / 0.02, 1e-9);
    }
  }
}

TEST(ParallelPlanesFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(2);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 100; ++trial) {
      const SE3 T_w1 = random.motion(3, 4), T_w2 = random.motion(3, 4);
      const Plane a = random_plane(random, 4), b = random_plane(random, 4);
      const ParallelPlanesFactor two(form, PlaneFrames::kTwo, 0.1);
      const ParallelPlanesFactor one(form, PlaneFrames::kOne, 0.1);
      expect_true_derivatives(two, {Block::of(T_w1), Block::of(a), Block::of(T_w2), Block::of(b)});
      expect_true_derivatives(one, {Block::of(a), Block::of(b)});
      const Plane b_in_1 = b.transformed(T_w1.inverse() * T_w2);
      const Eigen::VectorXd difference =
          residual(two, {Block::of(T_w1), Block::of(a), Block::of(T_w2), Block::of(b)}) -
          residual(one, {Block::of(a), Block::of(b_in_1)});
      EXPECT_LT(difference.norm(), 1e-9);
    }
  }
}

// Two planes observed with an angle between them, and held to be parallel.
struct Pair {
  Plane a, b;
};
Pair adjusted(const Pair& start, FactorForm form, PlaneFrames frames, double sigma, int steps) {
  FactorGraph graph;
  const SE3 T_w1 = Random(9).motion(1, 2), T_w2 = Random(10).motion(1, 2);
  const SE3 T_2w = frames == PlaneFrames::kTwo ? T_w2.inverse() : T_w1.inverse();
  const Plane start_a = start.a.transformed(T_w1.inverse()), start_b = start.b.transformed(T_2w);
  double* a = graph.add(start_a);
  double* b = graph.add(start_b);
  for (const auto& [plane, block] : {std::pair(start_a, a), std::pair(start_b, b)}) {
    const Plane facing = plane.facing_origin();
    graph.connect(new ReferencePlaneObservationFactor(
                      FactorForm::kRobust,
                      PlaneMeasurement::isotropic(facing.normal(),
                                                  -facing.offset() * facing.normal(), 0.1, 0.01)),
                  nullptr, block);
  }
  auto* factor = new ParallelPlanesFactor(form, frames, sigma);
  if (frames == PlaneFrames::kTwo) {
    graph.connect(factor, nullptr, graph.add(T_w1, true), a, graph.add(T_w2, true), b);
  } else {
    graph.connect(factor, nullptr, a, b);
  }
  graph.solve(steps);
  return {PlaneManifold::unpack(a).transformed(T_w1),
          PlaneManifold::unpack(b).transformed(T_2w.inverse())};
}

TEST(ParallelPlanesFactor, MakesTwoNearlyParallelPlanesParallel) {
  Random random(3);
  for (const PlaneFrames frames : {PlaneFrames::kOne, PlaneFrames::kTwo}) {
    for (int trial = 0; trial < 10; ++trial) {
      Pair start{random_plane(random, 4), {}};
      start.b = tilted(start.a, 5 * kDegree, random);
      if (trial % 2 == 0) start.b = start.b.flipped();
      const Pair end = adjusted(start, FactorForm::kRobust, frames, 1e-4, 50);
      EXPECT_LT(angle_between(end.a, end.b), 0.01 * kDegree);
      EXPECT_NEAR(angle_between(end.a, start.a), 2.5 * kDegree, 0.1 * kDegree) << "both give way";
      EXPECT_NEAR(angle_between(end.b, start.b), 2.5 * kDegree, 0.1 * kDegree);
    }
  }
}

TEST(ParallelPlanesFactor, PaperFormPullsFromTenDegreesButIsFlatAtItsSolution) {
  Random random(4);
  const Plane a = random_plane(random, 4), b = tilted(a, 10 * kDegree, random);
  const Pair end = adjusted({a, b}, FactorForm::kPaper, PlaneFrames::kTwo, 1e-4, 50);
  EXPECT_LT(angle_between(end.a, end.b), 2 * kDegree);
  const Pair robust = adjusted({a, b}, FactorForm::kRobust, PlaneFrames::kTwo, 1e-4, 50);
  EXPECT_LT(angle_between(robust.a, robust.b), 0.02 * kDegree);

  const Block blocks[] = {Block::of(a), Block::of(tilted(a, 0, random))};
  const double* parameters[] = {blocks[0].values.data(), blocks[1].values.data()};
  double e;
  Eigen::RowVector4d by_a, by_b;
  double* jacobians[] = {by_a.data(), by_b.data()};
  const ParallelPlanesFactor paper(FactorForm::kPaper, PlaneFrames::kOne, 1);
  ASSERT_TRUE(paper.Evaluate(parameters, &e, jacobians));
  EXPECT_LT(by_a.norm() + by_b.norm(), 1e-6);
}

}  // namespace
}  // namespace cairn
