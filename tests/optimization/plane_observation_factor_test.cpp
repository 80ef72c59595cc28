#include "cairn/optimization/factors/plane_observation_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

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

constexpr FactorForm kForms[] = {FactorForm::kPaper, FactorForm::kRobust};
constexpr double kDegree = M_PI / 180;

// What a camera sees of a plane of its own frame, off by an angle and a distance at the centroid.
PlaneMeasurement see(const Plane& plane, Random& random, double sigma_angle = 0,
                     double sigma_offset = 0) {
  const Plane facing = plane.facing_origin();
  Vector3d centroid = point_on(facing, random, 1);
  centroid += sigma_offset * random.gaussian() * facing.normal();
  const double a = sigma_angle * random.gaussian(), b = sigma_angle * random.gaussian();
  const Vector3d turn = tangent_axes(facing.normal()) * Eigen::Vector2d(a, b);
  return PlaneMeasurement::isotropic(so3_exp(turn) * facing.normal(), centroid,
                                     std::max(sigma_angle, 0.01), std::max(sigma_offset, 0.01));
}

Eigen::Matrix3d random_square_root(Random& random) {
  Eigen::Matrix3d W;
  for (int i = 0; i < 9; ++i) W(i) = random.gaussian();
  return 10 * W;
}

TEST(PlaneObservationFactor, IsZeroForThePlaneThatIsSeenWhicheverItsSign) {
  Random random(1);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 30; ++trial) {
      const SE3 T_wr = random.motion(3, 4), T_wc = random.motion(3, 4);
      const Plane plane_w = random_plane(random, 4);
      const Plane plane_r = plane_w.transformed(T_wr.inverse());
      const PlaneMeasurement seen = see(plane_w.transformed(T_wc.inverse()), random);
      const PlaneObservationFactor factor(form, seen);
      for (const Plane& same : {plane_r, plane_r.flipped()}) {
        const std::vector<Block> blocks = {Block::of(T_wr), Block::of(T_wc), Block::of(same)};
        EXPECT_LT(residual(factor, blocks).norm(), 1e-10);
      }
    }
  }
}

TEST(PlaneObservationFactor, PaperFormIsTheArcOnTheSphere) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    PlaneMeasurement seen = see(random_plane(random, 4), random);
    seen.sphere_sigma = 0.1;
    const Plane predicted = random_plane(random, 4);
    const ReferencePlaneObservationFactor factor(FactorForm::kPaper, seen);
    EXPECT_LT((residual(factor, {Block::of(predicted)}) - seen.plane().log(predicted) / 0.1).norm(),
              1e-10);
  }
}

TEST(PlaneObservationFactor, RobustFormIsAnAngleAndADistanceAtTheCentroid) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const PlaneMeasurement seen = see(random_plane(random, 4), random);
    const double angle = random.uniform(0, 1.5), off = random.uniform(-1, 1);
    const Vector3d axis = tangent_axes(seen.normal).col(1);
    const Vector3d normal = so3_exp(angle * axis) * seen.normal;
    const Plane predicted = Plane::through(seen.centroid - off * normal, normal);
    for (const Plane& same : {predicted, predicted.flipped()}) {
      const Eigen::VectorXd e =
          residual(ReferencePlaneObservationFactor(FactorForm::kRobust, seen), {Block::of(same)});
      EXPECT_NEAR(e.head<2>().norm(), angle / 0.01, 1e-7);
      EXPECT_NEAR(e[2], off / 0.01, 1e-9);
    }
  }
}

TEST(PlaneObservationFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(4);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 100; ++trial) {
      const SE3 T_wr = random.motion(3, random.uniform(0, 4));
      const SE3 T_wc = random.motion(3, random.uniform(0, 4));
      const Plane plane_w = random_plane(random, 4);
      PlaneMeasurement seen = see(plane_w.transformed(T_wc.inverse()), random);
      seen.square_root_information = random_square_root(random);
      const double size = trial % 4 == 0 ? 0 : random.uniform(0, 0.6);  // of the error
      const Plane plane_r = plane_w.transformed(T_wr.inverse()).exp(size * random.direction());
      const std::vector<Block> blocks = {Block::of(T_wr), Block::of(T_wc), Block::of(plane_r)};
      const PlaneObservationFactor factor(form, seen);
      expect_true_derivatives(factor, blocks, 1e-5);
      expect_true_derivatives(ReferencePlaneObservationFactor(form, seen),
                              {Block::of(seen.plane().exp(size * random.direction()))}, 1e-5);
      const Plane shifted_w = plane_r.transformed(T_wr);
      const FixedPlaneObservationFactor fixed(form, seen, shifted_w);
      expect_true_derivatives(fixed, {Block::of(T_wc)}, 1e-5);
      EXPECT_LT((residual(fixed, {Block::of(T_wc)}) - residual(factor, blocks)).norm(), 1e-8);
    }
  }
}

TEST(PlaneObservationFactor, StaysFiniteForThePlaneAtInfinity) {
  Random random(5);
  for (const FactorForm form : kForms) {
    const PlaneMeasurement seen = see(random_plane(random, 4), random);
    const Eigen::VectorXd e = residual(ReferencePlaneObservationFactor(form, seen),
                                       {Block::of(Plane(Eigen::Vector4d(0, 0, 0, 1)))});
    EXPECT_TRUE(e.allFinite());
  }
}

TEST(PlaneMeasurement, TakesItsInformationFromAFit) {
  Random random(6);
  const Plane plane(Vector3d(0.6, 0, -0.8), 3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 200; ++i) {
    points.push_back(point_on(plane, random, 1) + 0.02 * random.gaussian() * plane.normal());
  }
  const PlaneFit fit = fit_plane(points);
  const PlaneMeasurement seen = PlaneMeasurement::from_fit(fit, 0.03, 0.05);
  EXPECT_THAT(seen.plane(), IsNearPlane(fit.plane, 1e-9, 1e-9));
  Eigen::Matrix3d expected = fit.covariance;
  expected.diagonal() += Vector3d(0.03, 0.03, 0.05).cwiseAbs2();
  const Eigen::Matrix3d& W = seen.square_root_information;
  EXPECT_TRUE((W.transpose() * W * expected).isIdentity(1e-9));
  EXPECT_NEAR(seen.sphere_sigma, 0.03, 0.002);
}

// One keyframe saw the plane first and three see it: together they know it better than one.
TEST(PlaneObservationFactor, ThreeKeyframesFindThePlane) {
  for (const FactorForm form : kForms) {
    Random random(7);
    double one = 0, all = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Plane plane_w = Plane(random.direction(), 4);
      FactorGraph graph;
      std::vector<SE3> T_wc;
      std::vector<PlaneMeasurement> seen;
      for (int i = 0; i < 3; ++i) {
        T_wc.push_back(random.motion(0.5, 0.5));
        seen.push_back(see(plane_w.transformed(T_wc[i].inverse()), random, 2 * kDegree, 0.02));
      }
      double* reference = graph.add(T_wc[0], true);
      double* plane = graph.add(seen[0].plane().exp(0.3 * random.direction()));
      graph.connect(new ReferencePlaneObservationFactor(form, seen[0]), nullptr, plane);
      for (int i = 1; i < 3; ++i) {
        graph.connect(new PlaneObservationFactor(form, seen[i]), nullptr, reference,
                      graph.add(T_wc[i], true), plane);
      }
      graph.solve();
      const Plane found_w = PlaneManifold::unpack(plane).transformed(T_wc[0]);
      EXPECT_THAT(found_w, IsNearPlane(plane_w, 5, 0.35));
      one += std::pow(angle_between(seen[0].plane().transformed(T_wc[0]), plane_w), 2);
      all += std::pow(angle_between(found_w, plane_w), 2);
    }
    EXPECT_LT(all, 0.5 * one) << "a third of the variance is expected";
  }
}

// Three walls of a room hold all six degrees of freedom of a camera.
TEST(PlaneObservationFactor, PullsADisplacedCameraBack) {
  Random random(8);
  const Plane room[] = {Plane(Vector3d::UnitX(), 3), Plane(Vector3d::UnitY(), 2),
                        Plane(Vector3d(0, 0.1, -1).normalized(), 4)};
  for (const FactorForm form : kForms) {
    for (const bool tracking : {false, true}) {
      for (int trial = 0; trial < 10; ++trial) {
        const SE3 T_wr = random.motion(0.3, 0.5), T_wc = random.motion(0.3, 0.5);
        const SE3 start = T_wc * random.motion(20 * kDegree, 0.4);
        FactorGraph graph;
        double* reference = graph.add(T_wr, true);
        double* camera = graph.add(start);
        for (const Plane& plane_w : room) {
          const PlaneMeasurement seen = see(plane_w.transformed(T_wc.inverse()), random);
          if (tracking) {
            graph.connect(new FixedPlaneObservationFactor(form, seen, plane_w), nullptr, camera);
          } else {
            graph.connect(new PlaneObservationFactor(form, seen), nullptr, reference, camera,
                          graph.add(plane_w.transformed(T_wr.inverse()), true));
          }
        }
        graph.solve();
        EXPECT_LT((SE3Manifold::unpack(camera).inverse() * T_wc).log().norm(), 1e-6);
      }
    }
  }
}

// The reference moves the landmark with it: its pose is pulled just as the observer's is.
TEST(PlaneObservationFactor, PullsADisplacedReferenceBack) {
  Random random(9);
  const Plane room[] = {Plane(Vector3d::UnitX(), 3), Plane(Vector3d::UnitY(), 2),
                        Plane(Vector3d::UnitZ(), -4)};
  for (const FactorForm form : kForms) {
    const SE3 T_wr = random.motion(0.3, 0.5), T_wc = random.motion(0.3, 0.5);
    FactorGraph graph;
    double* reference = graph.add(T_wr * random.motion(20 * kDegree, 0.4));
    double* camera = graph.add(T_wc, true);
    for (const Plane& plane_w : room) {
      const PlaneMeasurement seen = see(plane_w.transformed(T_wc.inverse()), random);
      graph.connect(new PlaneObservationFactor(form, seen), nullptr, reference, camera,
                    graph.add(plane_w.transformed(T_wr.inverse()), true));
    }
    graph.solve();
    EXPECT_LT((SE3Manifold::unpack(reference).inverse() * T_wr).log().norm(), 1e-6);
  }
}

}  // namespace
}  // namespace cairn
