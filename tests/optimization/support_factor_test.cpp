#include "cairn/optimization/factors/support_factor.h"

#include <gtest/gtest.h>

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

Ellipsoid random_ellipsoid(Random& random) {
  const double a = random.uniform(0.1, 0.6), b = random.uniform(0.1, 0.6);
  return {random.motion(3, random.uniform(0, 3)), Vector3d(a, b, random.uniform(0.1, 0.6))};
}

double reach(const Ellipsoid& e, const Vector3d& normal) {
  const Vector3d n = e.T.rotation().conjugate() * normal;
  return e.semi_axes.cwiseProduct(n).norm();
}

// Between the surface and the plane, on that side of it.
double gap(const Ellipsoid& e, const Plane& plane, double side) {
  return side * plane.signed_distance(e.centre()) - reach(e, plane.normal());
}

// On the plane on that side, `gap` above it.
Ellipsoid standing(const Plane& plane, double side, double gap, Random& random) {
  const Ellipsoid e = random_ellipsoid(random);
  const double height = side * (reach(e, plane.normal()) + gap);
  const Vector3d centre = testing::point_on(plane, random, 2) + height * plane.normal();
  return {SE3(e.T.rotation(), centre), e.semi_axes};
}

Ellipsoid moved(const SE3& T, const Ellipsoid& e) { return {T * e.T, e.semi_axes}; }

TEST(SupportFactor, IsZeroWhereAnObjectTouchesThePlane) {
  Random random(1);
  for (const double side : {-1.0, 1.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const SE3 T_wp = random.motion(3, 2), T_wr = random.motion(3, 2);
      const Plane plane_w = random_plane(random, 3);
      const Ellipsoid object_w = standing(plane_w, side, 0, random);
      const std::vector<Block> blocks = {
          Block::of(T_wp), Block::of(plane_w.transformed(T_wp.inverse())), Block::of(T_wr),
          Block::of(moved(T_wr.inverse(), object_w))};
      for (const FactorForm form : kForms) {
        EXPECT_NEAR(residual(SupportFactor(form, SupportFrames::kTwo, side, 0.1), blocks)[0], 0,
                    1e-9);
      }
      const SupportFactor wrong_side(FactorForm::kRobust, SupportFrames::kTwo, -side, 0.1);
      EXPECT_NEAR(residual(wrong_side, blocks)[0], -2 * reach(object_w, plane_w.normal()) / 0.1,
                  1e-8);
    }
  }
}

TEST(SupportFactor, RobustFormIsTheGapInSigmas) {
  Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const Plane plane = random_plane(random, 3);
    const double off = random.uniform(-0.3, 1);
    const Ellipsoid object = standing(plane, -1, off, random);
    const SupportFactor factor(FactorForm::kRobust, SupportFrames::kOne, -1, 0.05);
    EXPECT_NEAR(residual(factor, {Block::of(plane), Block::of(object)})[0], off / 0.05, 1e-8);
  }
}

TEST(SupportFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(3);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 100; ++trial) {
      const SE3 T_wp = random.motion(3, 2), T_wr = random.motion(3, 2);
      const Plane plane = random_plane(random, 3);
      const Ellipsoid object = random_ellipsoid(random);
      const double side = random.below(2) == 0 ? -1 : 1, sigma = random.uniform(0.05, 1);
      expect_true_derivatives(
          SupportFactor(form, SupportFrames::kTwo, side, sigma),
          {Block::of(T_wp), Block::of(plane), Block::of(T_wr), Block::of(object)}, 1e-5);
      const SupportFactor one(form, SupportFrames::kOne, side, sigma);
      expect_true_derivatives(one, {Block::of(plane), Block::of(object)}, 1e-5);
    }
  }
}

// Each of the four blocks alone can close the gap.
TEST(SupportFactor, BringsObjectAndPlaneTogether) {
  Random random(4);
  for (const FactorForm form : kForms) {
    for (int free = 0; free < 4; ++free) {
      const SE3 T_wp = random.motion(1, 1), T_wr = random.motion(1, 1);
      const Plane plane_w = random_plane(random, 2);
      const Ellipsoid object_w = standing(plane_w, 1, 0.1, random);
      FactorGraph graph;
      double* plane_pose = graph.add(T_wp, free != 0);
      double* plane = graph.add(plane_w.transformed(T_wp.inverse()), free != 1);
      double* object_pose = graph.add(T_wr, free != 2);
      double* object = graph.add(moved(T_wr.inverse(), object_w), free != 3);
      graph.connect(new SupportFactor(form, SupportFrames::kTwo, 1, 0.05), nullptr, plane_pose,
                    plane, object_pose, object);
      graph.solve();
      const Plane found_plane =
          PlaneManifold::unpack(plane).transformed(SE3Manifold::unpack(plane_pose));
      const Ellipsoid found =
          moved(SE3Manifold::unpack(object_pose), ObjectManifold::unpack(object));
      EXPECT_NEAR(gap(found, found_plane, 1), 0, 1e-5) << "block " << free;
    }
  }
}

// What the paper form cannot: its gradient vanishes where the plane halves the object.
TEST(SupportFactor, RobustFormLiftsAnObjectThatThePlaneHalves) {
  Random random(5);
  const Plane plane(Vector3d::UnitZ(), 0.5);
  Ellipsoid object = random_ellipsoid(random);
  object.T = SE3(object.T.rotation(), Vector3d(1, 1, -0.5));
  FactorGraph graph;
  double* blocks[] = {graph.add(plane, true), graph.add(object)};
  graph.connect(new SupportFactor(FactorForm::kRobust, SupportFrames::kOne, 1, 0.05), nullptr,
                blocks[0], blocks[1]);
  graph.solve();
  const Ellipsoid found = ObjectManifold::unpack(blocks[1]);
  EXPECT_NEAR(gap(found, plane, 1), 0, 1e-5);
  EXPECT_GT(found.centre().z(), object.centre().z());
}

}  // namespace
}  // namespace cairn
