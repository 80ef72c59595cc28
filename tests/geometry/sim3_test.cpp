#include "cairn/geometry/sim3.h"

#include <gmock/gmock.h>

#include <limits>

#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::Random;

Sim3 random_similarity(Random& random) {
  const SE3 T = random.motion(3, 5);
  return Sim3(random.uniform(0.2, 4), T.rotation(), T.translation());
}

std::vector<Vector3d> random_points(Random& random, int count) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.gaussian3() * 3);
  return points;
}

TEST(Sim3, ComposesAndInvertsLikeItsMatrix) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Sim3 A = random_similarity(random), B = random_similarity(random);
    const Vector3d x = random.gaussian3();
    EXPECT_LT(((A * B).matrix() - A.matrix() * B.matrix()).norm(), 1e-10);
    EXPECT_LT((A * (B * x) - (A * B) * x).norm(), 1e-10);
    EXPECT_LT((A.inverse() * (A * x) - x).norm(), 1e-10);
    EXPECT_LT(((A * A.inverse()).matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-10);
  }
}

TEST(Sim3, ComesBackFromItsLogarithmAtEverySize) {
  Random random(2);
  for (const double size : {1e-12, 1e-8, 1e-5, 9e-4, 1.1e-3, 1e-2, 1.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      Vector7d xi;
      xi << random.gaussian3(), random.direction() * size * 3, size * random.uniform(-1.5, 1.5);
      EXPECT_LT((Sim3::exp(xi).log() - xi).norm(), 1e-9) << size;
      xi[6] = random.uniform(-1, 1);
      EXPECT_LT((Sim3::exp(xi).log() - xi).norm(), 1e-9) << size;
    }
  }
}

TEST(Sim3, ExponentialIsTheOneParameterGroup) {
  Random random(3);
  Vector7d xi;
  xi << random.gaussian3(), random.direction(), 0.7;
  const Sim3 half = Sim3::exp(0.5 * xi);
  EXPECT_LT(((half * half).matrix() - Sim3::exp(xi).matrix()).norm(), 1e-12);
}

TEST(Sim3, AgreesWithSE3WhereTheScaleIsOne) {
  Random random(4);
  Vector7d xi;
  xi << random.gaussian3(), random.direction(), 0;
  EXPECT_LT((Sim3::exp(xi).matrix() - SE3::exp(xi.head<6>()).matrix()).norm(), 1e-12);
}

TEST(Sim3, MovesACameraWithItsWorld) {
  Random random(5);
  const Sim3 S = random_similarity(random);
  const SE3 T_wc = random.motion(1, 2);
  const Vector3d x = random.gaussian3();
  // What the camera sees keeps its direction; its distance takes the new unit.
  EXPECT_LT((S.move(T_wc).inverse() * (S * x) - S.scale() * (T_wc.inverse() * x)).norm(), 1e-10);
}

TEST(Umeyama, FindsAKnownSimilarity) {
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Sim3 truth = random_similarity(random);
    const std::vector<Vector3d> from = random_points(random, 3 + trial);
    std::vector<Vector3d> to;
    for (const Vector3d& x : from) to.push_back(truth * x);
    const SimilarityFit found = align_umeyama(from, to, true);
    ASSERT_TRUE(found.usable) << found.refusal;
    EXPECT_LT((found.transform.matrix() - truth.matrix()).norm(), 1e-9);
    EXPECT_LT(found.rmse, 1e-9);
  }
}

TEST(Umeyama, KeepsTheScaleWhenAskedTo) {
  Random random(7);
  const std::vector<Vector3d> from = random_points(random, 40);
  std::vector<Vector3d> to;
  for (const Vector3d& x : from) to.push_back(1.5 * x + Vector3d(1, 2, 3));
  const SimilarityFit found = align_umeyama(from, to, false);
  ASSERT_TRUE(found.usable);
  EXPECT_EQ(found.transform.scale(), 1);
  EXPECT_GT(found.rmse, 0.1);
}

TEST(Umeyama, FindsARotationAndNoReflectionForPointsOnAPlane) {
  Random random(8);
  const Sim3 truth = random_similarity(random);
  std::vector<Vector3d> from = random_points(random, 20), to;
  for (Vector3d& x : from) {
    x.z() = 0;
    to.push_back(truth * x);
  }
  const SimilarityFit found = align_umeyama(from, to, true);
  ASSERT_TRUE(found.usable);
  EXPECT_LT((found.transform.matrix() - truth.matrix()).norm(), 1e-9);
}

TEST(Umeyama, RefusesDegenerateSetsInWords) {
  Random random(9);
  std::vector<Vector3d> cloud = random_points(random, 5), line, place(5, Vector3d(1, 2, 3));
  for (int i = 0; i < 5; ++i) line.push_back(Vector3d(1, 2, 3) * i);
  EXPECT_THAT(align_umeyama({cloud.data(), 2}, {cloud.data(), 2}, true).refusal,
              HasSubstr("only 2 points"));
  EXPECT_THAT(align_umeyama(cloud, {cloud.data(), 2}, true).refusal, HasSubstr("one to one"));
  EXPECT_THAT(align_umeyama(line, cloud, true).refusal, HasSubstr("one line"));
  EXPECT_THAT(align_umeyama(cloud, place, true).refusal, HasSubstr("one place"));
  cloud[2].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(align_umeyama(cloud, cloud, true).refusal, HasSubstr("not finite"));
}

}  // namespace
}  // namespace cairn
