#include "cairn/synthetic/ellipsoid_trial.h"

#include <gtest/gtest.h>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// Of the reference, which printed that many digits; seed 2, span 30 degrees.
void expect_view(const EllipsoidTrial::View& view, const Vector3d& centre, const Vector3d& forward,
                 const Vector4d& box, double score) {
  EXPECT_LT((view.T_cw.inverse().translation() - centre).norm(), 2e-5);
  EXPECT_LT((view.T_cw.matrix3().row(2).transpose() - forward).norm(), 2e-5);
  EXPECT_LT((view.box.edges() - box).norm(), 2e-3);
  EXPECT_NEAR(view.score, score, 1e-4);
}

TEST(EllipsoidTrial, DrawsTheWordsOfTheReference) {
  Sampler sampler(1);
  EXPECT_EQ(sampler.next(), 0x910a2dec89025cc1u);
  EXPECT_EQ(sampler.next(), 0xbeeb8da1658eec67u);
  EXPECT_EQ(sampler.next(), 0xf893a2eefb32555eu);
}

TEST(EllipsoidTrial, HasTheThingAndTheStartOfTheReference) {
  const EllipsoidTrial trial = make_ellipsoid_trial(2, 30, TrialWorld::kClean);
  EXPECT_LT((trial.truth.semi_axes - Vector3d(0.093485, 0.150672, 0.102204)).norm(), 2e-6);
  Eigen::Matrix3d R;
  R << -0.875124, -0.477306, -0.079612, -0.465722, 0.786105, 0.406377, -0.131383, 0.392707,
      -0.910231;
  EXPECT_LT((trial.truth.T.matrix3() - R).norm(), 5e-6);
  EXPECT_EQ(trial.truth.centre().norm(), 0);
  EXPECT_LT((trial.start.centre() - Vector3d(0.041922, 0.145183, -0.025012)).norm(), 2e-6);
  EXPECT_LT((trial.start.semi_axes - Vector3d::Constant(0.076001)).norm(), 2e-6);
  const EllipsoidTrial displaced = make_ellipsoid_trial(2, 30, TrialWorld::kDisplaced);
  EXPECT_LT((displaced.start.centre() - Vector3d(0.104806, 0.362958, -0.062529)).norm(), 2e-6);
}

TEST(EllipsoidTrial, HasTheViewsOfTheReference) {
  const EllipsoidTrial clean = make_ellipsoid_trial(2, 30, TrialWorld::kClean);
  expect_view(clean.views[0], {1.32288, -0.35447, 0.51363}, {-0.87917, 0.26049, -0.39901},
              {263.755, 167.701, 350.937, 254.501}, 0.9610);
  expect_view(clean.views[11], {1.56615, 0.41965, 0.50474}, {-0.94933, -0.16244, -0.26904},
              {228.435, 220.953, 319.165, 289.124}, 0.9487);
  const EllipsoidTrial outliers = make_ellipsoid_trial(2, 30, TrialWorld::kOutliers);
  expect_view(outliers.views[7], {1.52057, 0.10875, 0.42079}, {-0.92523, -0.20377, -0.32005},
              {333.976, 198.864, 448.561, 241.056}, 0.8396);
  EXPECT_EQ(outliers.views[0].box.edges(), clean.views[0].box.edges());
}

TEST(EllipsoidTrial, TurnsTheCamerasOfTheReferenceAway) {
  const EllipsoidTrial trial = make_ellipsoid_trial(2, 30, TrialWorld::kTruncated);
  expect_view(trial.views[0], {1.32288, -0.35447, 0.51363}, {-0.95851, 0.28401, 0.02431},
              {258.46, 401.327, 352.835, 480.0}, 0.9610);
  expect_view(trial.views[3], {1.30015, -0.15545, 0.45043}, {-0.88676, -0.39315, -0.24308},
              {548.142, 265.034, 640.0, 357.678}, 0.9311);
  expect_view(trial.views[9], {1.50189, 0.25256, 0.5543}, {-0.73007, -0.11142, -0.67423},
              {263.937, 0.0, 361.324, 65.388}, 0.8947);
  EXPECT_EQ(trial.views[0].cut, (std::array{false, false, false, true}));
  EXPECT_EQ(trial.views[3].cut, (std::array{false, false, true, false}));
  EXPECT_EQ(trial.views[9].cut, (std::array{false, true, false, false}));
  EXPECT_EQ(trial.views[1].cut, (std::array{false, false, false, false}));
}

TEST(EllipsoidTrial, CutsAFifthToAHalfOffHalfOfItsViews) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const EllipsoidTrial trial = make_ellipsoid_trial(seed, 60, TrialWorld::kTruncated);
    int cut = 0;
    for (const auto& view : trial.views) {
      const auto box = projected_box(EllipsoidTrial::kPinhole,
                                     {view.T_cw * trial.truth.T, trial.truth.semi_axes});
      ASSERT_TRUE(box);
      const double lost = 1 - box->clipped(EllipsoidTrial::kPicture).area() / box->area();
      if (lost < 0.15) continue;
      ++cut;
      EXPECT_GT(lost, 0.2 - 1e-9);
      EXPECT_LT(lost, 0.5 + 1e-9);
    }
    EXPECT_EQ(cut, 6);
  }
}

}  // namespace
}  // namespace cairn
