#include "cairn/optimization/object_fit.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/parallax.h"
#include "geometry/scene.h"

namespace cairn {
namespace {

using Eigen::Vector3d;
using testing::kCamera;
using testing::Random;

const Ellipsoid kTruth{SE3(so3_exp({0.4, -0.7, 0.3}), {0.05, -0.1, 0.02}), {0.1, 0.15, 0.22}};
const Ellipsoid kStart{SE3(Eigen::Quaterniond::Identity(), {0, 0, 0}), Vector3d::Constant(0.1)};
const ObjectPrior kNoPrior{.usual = 0, .sigma_shape = 0};

SE3 looking(const Vector3d& from, const Vector3d& at) {
  const Vector3d forward = (at - from).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  return SE3(R, -(R * from));
}

// Cameras 1.5 from the origin, on an arc that climbs; boxes with `noise` pixels on each edge.
std::vector<BoxView> views_of(double span_deg, double noise = 0) {
  Random random(7);
  std::vector<BoxView> views;
  for (int i = 0; i < 12; ++i) {
    const double angle = (i / 11.0 - 0.5) * span_deg * M_PI / 180;
    const double height = 0.3 + 0.8 * angle;
    BoxView view;
    view.T_cw = looking(1.5 * Vector3d(std::cos(angle), std::sin(angle), height), Vector3d::Zero());
    const auto box = projected_box(kCamera, {view.T_cw * kTruth.T, kTruth.semi_axes});
    EXPECT_TRUE(box);
    double edges[4] = {box->x0, box->y0, box->x1, box->y1};
    for (double& edge : edges) edge += noise * random.gaussian();
    view.box = {edges[0], edges[1], edges[2], edges[3]};
    views.push_back(view);
  }
  return views;
}

double overlap(const ObjectFit& fit) { return intersection_over_union(kTruth, fit.ellipsoid); }

TEST(ObjectFit, FindsTheTruthFromPerfectBoxes) {
  const auto views = views_of(100);
  ObjectFitOptions options;
  options.loss = 100;
  const ObjectFit fit = fit_object(kStart, views, kCamera, kNoPrior, options);
  EXPECT_TRUE(fit.usable) << fit.to_string();
  EXPECT_GT(overlap(fit), 0.99) << fit.to_string();
  EXPECT_LT((fit.ellipsoid.centre() - kTruth.centre()).norm(), 1e-3);
  EXPECT_LT(fit.median_error, 0.1);
  EXPECT_EQ(fit.views, 12);
  EXPECT_EQ(fit.agreeing, 12);
}

TEST(ObjectFit, StaysAtTheTruth) {
  for (const FactorForm form : {FactorForm::kPaper, FactorForm::kRobust}) {
    ObjectFitOptions options;
    options.form = form;
    const ObjectFit fit = fit_object(kTruth, views_of(60), kCamera, kNoPrior, options);
    EXPECT_TRUE(fit.usable) << fit.to_string();
    EXPECT_GT(overlap(fit), 0.99) << fit.to_string();
    EXPECT_NEAR(fit.cost, 0, 1e-9);
  }
}

TEST(ObjectFit, IsNotMovedByBoxesOfSomethingElse) {
  auto views = views_of(60, 1);
  const ObjectPrior prior{.usual = 0.15};
  const ObjectFit before = fit_object(kStart, views, kCamera, prior);
  for (const std::size_t wrong : {2u, 9u}) {
    Box2& box = views[wrong].box;
    box = {box.x0 + 90, box.y0 - 40, box.x1 + 60, box.y1 - 70};
  }
  const ObjectFit after = fit_object(kStart, views, kCamera, prior);
  ASSERT_TRUE(before.usable && after.usable);
  EXPECT_GT(intersection_over_union(before.ellipsoid, after.ellipsoid), 0.8) << after.to_string();
  EXPECT_LT((before.ellipsoid.centre() - after.ellipsoid.centre()).norm(), 0.015);
  EXPECT_LE(after.agreeing, 10);
  EXPECT_GE(after.agreeing, 9);
}

TEST(ObjectFit, IsSeenFromWhereBoxesAgreeWithIt) {
  auto views = views_of(60);
  const ObjectPrior prior{.usual = 0.15};
  const auto eye_of = [](const BoxView& view) { return view.T_cw.inverse().translation(); };
  const double all = fit_object(kStart, views, kCamera, prior).span;
  EXPECT_NEAR(all, largest_parallax(views, kTruth.centre(), eye_of), 0.02);
  Box2& box = views.front().box;
  box = {box.x0 + 90, box.y0 - 40, box.x1 + 60, box.y1 - 70};
  const std::span<const BoxView> others(views.begin() + 1, views.end());
  EXPECT_NEAR(fit_object(kStart, views, kCamera, prior).span,
              largest_parallax(others, kTruth.centre(), eye_of), 0.02);
}

TEST(ObjectFit, TakesNoCutEdgeForAnEdge) {
  auto views = views_of(60, 1);
  const ObjectPrior prior{.usual = 0.15};
  for (std::size_t i = 0; i < views.size(); i += 2) {
    Box2& box = views[i].box;
    box.x0 += 0.4 * box.width();
    views[i].cut[0] = true;
  }
  const ObjectFit masked = fit_object(kStart, views, kCamera, prior);
  for (BoxView& view : views) view.cut = {};
  const ObjectFit taken = fit_object(kStart, views, kCamera, prior);
  ASSERT_TRUE(masked.usable);
  EXPECT_GT(overlap(masked), 0.6) << masked.to_string();
  EXPECT_EQ(masked.agreeing, 12);
  EXPECT_LT(taken.agreeing, 12);
}

TEST(ObjectFit, HoldsAThingToTheCutEdgeAtLeast) {
  const ObjectPrior prior{.usual = 0.15};
  auto views = views_of(20);
  views.resize(1);
  Box2& box = views[0].box;
  box.x0 -= 60;  // the picture shows more of it than without the cut
  views[0].cut[0] = true;
  const ObjectFit held = fit_object(kStart, views, kCamera, prior);
  views[0].box.x0 += 120;  // and less: the border says nothing
  const ObjectFit free = fit_object(kStart, views, kCamera, prior);
  ASSERT_TRUE(held.usable && free.usable);
  const auto left_edge = [&](const ObjectFit& fit) {
    const Ellipsoid seen{views[0].T_cw * fit.ellipsoid.T, fit.ellipsoid.semi_axes};
    return projected_box(kCamera, seen)->x0;
  };
  EXPECT_LT(left_edge(held), left_edge(free) - 20);
}

TEST(ObjectFit, IsBoundedByItsPriorWithoutParallax) {
  const auto views = views_of(0, 1);
  const ObjectFit fit = fit_object(kStart, views, kCamera, {.usual = 0.15});
  ASSERT_TRUE(fit.usable) << fit.to_string();
  const double size = std::cbrt(fit.ellipsoid.semi_axes.prod());
  EXPECT_GT(size, 0.15 / 2);
  EXPECT_LT(size, 0.15 * 2);
  EXPECT_LT(fit.ellipsoid.centre().norm(), 1.5);
  // Along the ray nothing but the prior says how far it is.
  const Vector3d ray = fit.ellipsoid.T.rotation().conjugate() *
                       (views[0].T_cw.rotation().conjugate() * Vector3d::UnitZ());
  const double sigma = std::sqrt(ray.dot(fit.covariance.topLeftCorner<3, 3>() * ray));
  EXPECT_GT(sigma, 0.2);
  // If nothing says it, the covariance has no end.
  EXPECT_FALSE(fit_object(kStart, {views.data(), 1}, kCamera, {.usual = 0}).usable);
}

TEST(ObjectFit, HasTheSizeAndShapeOfItsClassWhereItsBoxesSayNothing) {
  const Vector3d axes(0.3, 0.1, 0.15);
  ObjectPrior prior;
  prior.usual = std::cbrt(axes.prod());
  prior.shape = (axes / prior.usual).array().log();
  prior.sigma_size = 0.2;
  auto views = views_of(0);
  for (BoxView& view : views) view.sigma = 1e5;
  const ObjectFit fit = fit_object(kStart, views, kCamera, prior);
  ASSERT_TRUE(fit.usable);
  EXPECT_LT((fit.ellipsoid.semi_axes - axes).norm(), 1e-3) << fit.ellipsoid.semi_axes.transpose();
}

TEST(ObjectFit, StandsOnItsGroundWhereItsBoxesSayNoHeight) {
  const Plane floor(Vector3d::UnitZ(), 0.4);
  ObjectPrior prior{.usual = 0.15};
  prior.ground = floor;
  prior.sigma_ground = 0.005;
  auto views = views_of(60);
  for (BoxView& view : views) view.cut[3] = true;  // something hides where it ends
  const ObjectFit fit = fit_object(kStart, views, kCamera, prior);
  ASSERT_TRUE(fit.usable);
  EXPECT_NEAR(ground_residual(prior, fit.ellipsoid, nullptr), 0, 2);
  prior.ground.reset();
  EXPECT_EQ(ground_residual(prior, fit.ellipsoid, nullptr), 0);
}

TEST(ObjectPrior, HasTheTrueDerivativeOfTheGapToTheGround) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    ObjectPrior prior;
    prior.ground = Plane(random.direction(), random.uniform(-1, 1));
    prior.sigma_ground = 0.02;
    const Ellipsoid e{random.motion(1, 2), {0.1, 0.2, 0.3}};
    Eigen::Matrix<double, 1, 9> by_step;
    ground_residual(prior, e, &by_step);
    for (int k = 0; k < 9; ++k) {
      const auto at = [&](double h) {
        Eigen::Matrix<double, 9, 1> step = Eigen::Matrix<double, 9, 1>::Zero();
        step[k] = h;
        return ground_residual(
            prior,
            {e.T * SE3::exp(step.head<6>()), e.semi_axes.array() * step.tail<3>().array().exp()},
            nullptr);
      };
      EXPECT_NEAR(by_step[k], (at(1e-6) - at(-1e-6)) / 2e-6, 1e-4) << k;
    }
  }
}

TEST(ObjectFit, SaysHowUnsureItIs) {
  const ObjectPrior prior{.usual = 0.15};
  const ObjectFit narrow = fit_object(kStart, views_of(10, 1), kCamera, prior);
  const ObjectFit wide = fit_object(kStart, views_of(90, 1), kCamera, prior);
  ASSERT_TRUE(narrow.usable && wide.usable);
  const auto spread = [](const ObjectFit& fit) {
    return fit.covariance.diagonal().head(3).sum();  // of the centre
  };
  EXPECT_LT(spread(wide), spread(narrow) / 2);
  EXPECT_NEAR((wide.covariance - wide.covariance.transpose()).norm(), 0, 1e-6);
}

TEST(ObjectFit, TakesABallWhoseTurnNoBoxShows) {
  auto views = views_of(60);
  for (BoxView& view : views) {
    view.box = *projected_box(kCamera, {view.T_cw * kStart.T, kStart.semi_axes});
  }
  const ObjectFit fit = fit_object(kStart, views, kCamera, {.usual = 0.1});
  EXPECT_TRUE(fit.usable);
  EXPECT_NEAR(fit.cost, 0, 1e-9);
}

// As of a table that one picture is taken above of.
TEST(ObjectFit, FindsAThingFromAStartThatReachesBehindACamera) {
  auto views = views_of(100);
  BoxView near = views[5];
  near.T_cw = looking({0.5, 0.1, 0.3}, Vector3d::Zero());
  near.box = *projected_box(kCamera, {near.T_cw * kTruth.T, kTruth.semi_axes});
  views.push_back(near);
  const Ellipsoid start{kStart.T, Vector3d::Constant(0.8)};
  ASSERT_FALSE(projected_box(kCamera, {near.T_cw * start.T, start.semi_axes}));
  const ObjectFit fit = fit_object(start, views, kCamera, kNoPrior);
  EXPECT_TRUE(fit.usable) << fit.to_string();
  EXPECT_EQ(fit.agreeing, 13);
  EXPECT_GT(overlap(fit), 0.95) << fit.to_string();
}

TEST(ObjectFit, IsNotUsableFromAStartThatIsNone) {
  const ObjectPrior prior{.usual = 0.15};
  const auto views = views_of(60);
  Ellipsoid start = kStart;
  EXPECT_FALSE(fit_object(start, {}, kCamera, prior).usable);
  start.semi_axes.y() = std::nan("");
  EXPECT_FALSE(fit_object(start, views, kCamera, prior).usable);
  start.semi_axes.y() = 0;
  EXPECT_FALSE(fit_object(start, views, kCamera, prior).usable);
  start = kStart;
  start.T = SE3(start.T.rotation(), {std::nan(""), 0, 0});
  EXPECT_FALSE(fit_object(start, views, kCamera, prior).usable);
  start.T = SE3(start.T.rotation(), {5, 0, 0});  // behind the cameras
  for (const FactorForm form : {FactorForm::kPaper, FactorForm::kRobust}) {
    ObjectFitOptions options;
    options.form = form;
    const ObjectFit fit = fit_object(start, views, kCamera, prior, options);
    EXPECT_FALSE(fit.usable);
    EXPECT_TRUE(fit.ellipsoid.semi_axes.allFinite());
  }
}

}  // namespace
}  // namespace cairn
