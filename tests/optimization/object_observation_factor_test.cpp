#include "cairn/optimization/factors/object_observation_factor.h"

#include <gtest/gtest.h>

#include "factor_check.h"
#include "factor_graph.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::Block;
using testing::expect_true_derivatives;
using testing::FactorGraph;
using testing::kCamera;
using testing::Random;
using testing::residual;

constexpr FactorForm kForms[] = {FactorForm::kPaper, FactorForm::kRobust};
constexpr double kDegree = M_PI / 180;

Ellipsoid moved(const SE3& T, const Ellipsoid& e) { return {T * e.T, e.semi_axes}; }

Vector3d random_axes(Random& random) {
  const double a = random.uniform(0.15, 0.5), b = random.uniform(0.15, 0.5);
  return {a, b, random.uniform(0.15, 0.5)};
}

// Somewhere in the picture of the camera in whose frame it is.
Ellipsoid in_picture(Random& random) {
  const double z = random.uniform(2, 5);
  const double x = random.uniform(-0.4, 0.4), y = random.uniform(-0.3, 0.3);
  return {SE3(random.motion(3, 0).rotation(), Vector3d(x * z, y * z, z)), random_axes(random)};
}

ObjectMeasurement see(const Ellipsoid& in_camera, Random& random, double noise = 0) {
  ObjectMeasurement seen;
  seen.pinhole = kCamera;
  const std::optional<Box2> box = projected_box(kCamera, in_camera);
  EXPECT_TRUE(box.has_value());
  if (box) seen.box = *box;
  for (double* edge : {&seen.box.x0, &seen.box.y0, &seen.box.x1, &seen.box.y1}) {
    *edge += noise * random.gaussian();
  }
  return seen;
}

// On an arc around the origin of the world, which they look at; every other one from high above.
std::vector<SE3> around_origin(int count) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    const double azimuth = (-60 + 120.0 * i / (count - 1)) * kDegree;
    const double elevation = (i % 2 == 0 ? 15 : 50) * kDegree;
    const Vector3d out(std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const Vector3d right = (-out).cross(Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d R_wc;
    R_wc << right, (-out).cross(right), -out;
    poses.emplace_back(R_wc, 2 * out);
  }
  return poses;
}

TEST(ObjectObservationFactor, IsZeroForTheBoxThatIsSeen) {
  Random random(1);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 30; ++trial) {
      const SE3 T_wr = random.motion(3, 4), T_wc = random.motion(3, 4);
      const Ellipsoid in_camera = in_picture(random);
      const ObjectObservationFactor factor(form, see(in_camera, random));
      const Ellipsoid in_reference = moved(T_wr.inverse() * T_wc, in_camera);
      EXPECT_LT(
          residual(factor, {Block::of(T_wr), Block::of(T_wc), Block::of(in_reference)}).norm(),
          1e-8);
    }
  }
}

TEST(ObjectObservationFactor, PaperFormIsOneMinusTheOverlap) {
  Random random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const Ellipsoid object = in_picture(random);
    ObjectMeasurement seen = see(object, random, 20);
    seen.sigma_iou = 0.2;
    seen.score = 0.25;
    const ReferenceObjectObservationFactor factor(FactorForm::kPaper, seen);
    const double iou = intersection_over_union(seen.box, *projected_box(kCamera, object));
    EXPECT_NEAR(residual(factor, {Block::of(object)})[0], 0.5 * (1 - iou) / 0.2, 1e-9);
    seen.box.x0 += 5000;
    seen.box.x1 += 5000;
    const ReferenceObjectObservationFactor elsewhere(FactorForm::kPaper, seen);
    EXPECT_NEAR(residual(elsewhere, {Block::of(object)})[0], 2.5, 1e-12);
    expect_true_derivatives(elsewhere, {Block::of(object)});  // which are zero
  }
}

TEST(ObjectObservationFactor, RobustFormIsTheEdgesOfWhichCutOnesCountInsideOnly) {
  Random random(3);
  const Ellipsoid object = in_picture(random);
  ObjectMeasurement seen = see(object, random);
  seen.box = {seen.box.x0 - 2, seen.box.y0 + 4, seen.box.x1 + 6, seen.box.y1 - 8};
  seen.score = 0.25;
  const auto edges = [&](const std::array<bool, 4>& cut) -> Eigen::Vector4d {
    seen.cut = cut;
    return residual(ReferenceObjectObservationFactor(FactorForm::kRobust, seen),
                    {Block::of(object)});
  };
  EXPECT_LT((edges({}) - Eigen::Vector4d(0.5, -1, -1.5, 2)).norm(), 1e-9);
  EXPECT_LT((edges({true, true, true, true}) - Eigen::Vector4d(0.5, 0, -1.5, 0)).norm(), 1e-9);
}

TEST(ObjectObservationFactor, DerivativesAgreeWithCentralDifferences) {
  Random random(4);
  for (const FactorForm form : kForms) {
    for (int trial = 0; trial < 100; ++trial) {
      const SE3 T_wr = random.motion(3, random.uniform(0, 4));
      const SE3 T_wk = random.motion(3, random.uniform(0, 4));
      const Ellipsoid in_camera = in_picture(random);
      ObjectMeasurement seen = see(in_camera, random, 15);
      for (bool& cut : seen.cut) cut = random.below(2) == 1;
      seen.score = random.uniform(0.3, 1);
      if (trial % 2 == 1) seen.T_kc = random.motion(0.5, 0.3);
      const Ellipsoid in_keyframe = moved(seen.T_kc, in_camera);
      const Ellipsoid in_reference = moved(T_wr.inverse() * T_wk, in_keyframe);
      expect_true_derivatives(ObjectObservationFactor(form, seen),
                              {Block::of(T_wr), Block::of(T_wk), Block::of(in_reference)}, 1e-5);
      expect_true_derivatives(ReferenceObjectObservationFactor(form, seen),
                              {Block::of(in_keyframe)}, 1e-5);
    }
  }
}

TEST(ObjectObservationFactor, IsAConstantForWhatIsNotInFrontOfTheCamera) {
  Random random(5);
  for (const FactorForm form : kForms) {
    for (const double z : {-3.0, 0.0}) {
      const ObjectMeasurement seen = see(in_picture(random), random);
      const Ellipsoid object{SE3(Eigen::Quaterniond::Identity(), Vector3d(0.1, 0.1, z)),
                             random_axes(random)};
      const ReferenceObjectObservationFactor factor(form, seen);
      const Eigen::VectorXd e = residual(factor, {Block::of(object)});
      EXPECT_TRUE(e.allFinite());
      EXPECT_GT(e.norm(), kObjectLoss);
      expect_true_derivatives(factor, {Block::of(object)});
    }
  }
}

TEST(ObjectObservationFactor, PullsADisplacedObjectToItsBoxes) {
  Random random(6);
  for (const FactorForm form : kForms) {
    const Ellipsoid truth{SE3(random.motion(3, 0).rotation(), Vector3d::Zero()),
                          Vector3d(0.25, 0.2, 0.15)};
    Ellipsoid start{SE3(truth.T.rotation(), Vector3d(0.06, -0.05, 0.04)), 1.3 * truth.semi_axes};
    const std::vector<SE3> poses = around_origin(10);
    FactorGraph graph;
    const SE3 T_rw = poses[0].inverse();
    double* reference = graph.add(poses[0], true);
    double* object = graph.add(moved(T_rw, start));
    const auto see_from = [&](const SE3& T_wc) {
      return see(moved(T_wc.inverse(), truth), random);
    };
    graph.connect(new ReferenceObjectObservationFactor(form, see_from(poses[0])), nullptr, object);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      graph.connect(new ObjectObservationFactor(form, see_from(poses[i])), nullptr, reference,
                    graph.add(poses[i], true), object);
    }
    const ceres::Solver::Summary summary = graph.solve();
    const Ellipsoid found = moved(poses[0], ObjectManifold::unpack(object));
    const double before = intersection_over_union(start, truth);
    const double after = intersection_over_union(found, truth);
    EXPECT_LT(summary.final_cost, summary.initial_cost);
    if (form == FactorForm::kRobust) {
      EXPECT_LT((found.centre() - truth.centre()).norm(), 0.005);
      EXPECT_GT(after, 0.95);
    } else {
      EXPECT_GT(after, before) << "its kinks stop it early";
    }
  }
}

// Four known things hold all six degrees of freedom of a camera, and of the reference that they
// hang on.
TEST(ObjectObservationFactor, PullsADisplacedKeyframeBack) {
  Random random(7);
  for (const bool reference_moves : {false, true}) {
    for (int trial = 0; trial < 5; ++trial) {
      const SE3 T_wr = random.motion(0.3, 0.5), T_wc = random.motion(0.3, 0.5);
      const SE3 off = random.motion(3 * kDegree, 0.1);
      FactorGraph graph;
      double* reference = graph.add(reference_moves ? T_wr * off : T_wr, !reference_moves);
      double* camera = graph.add(reference_moves ? T_wc : T_wc * off, reference_moves);
      for (const double x : {-0.8, 0.8}) {
        for (const double y : {-0.6, 0.6}) {
          const Vector3d centre(x, y, random.uniform(2.5, 4));
          const Ellipsoid in_camera{SE3(random.motion(3, 0).rotation(), centre),
                                    random_axes(random)};
          graph.connect(new ObjectObservationFactor(FactorForm::kRobust, see(in_camera, random)),
                        nullptr, reference, camera,
                        graph.add(moved(T_wr.inverse() * T_wc, in_camera), true));
        }
      }
      graph.solve();
      const SE3 found = SE3Manifold::unpack(reference_moves ? reference : camera);
      EXPECT_LT((found.inverse() * (reference_moves ? T_wr : T_wc)).log().norm(), 1e-4);
    }
  }
}

TEST(ObjectManifold, KeepsAnEllipsoidAndSteps) {
  Random random(8);
  const ObjectManifold manifold;
  for (int trial = 0; trial < 20; ++trial) {
    const Ellipsoid object = in_picture(random);
    const Block x = Block::of(object);
    const Ellipsoid same = ObjectManifold::unpack(x.values.data());
    EXPECT_LT((same.T.matrix() - object.T.matrix()).norm(), 1e-12);
    EXPECT_LT((same.semi_axes - object.semi_axes).norm(), 1e-12);
    ObjectManifold::Step step, back;
    for (int i = 0; i < 9; ++i) step[i] = 0.3 * random.gaussian();
    Block y = x;
    manifold.Plus(x.values.data(), step.data(), y.values.data());
    manifold.Minus(y.values.data(), x.values.data(), back.data());
    EXPECT_LT((back - step).norm(), 1e-9);
    EXPECT_GT(ObjectManifold::unpack(y.values.data()).semi_axes.minCoeff(), 0);
  }
}

}  // namespace
}  // namespace cairn
