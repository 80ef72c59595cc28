#include "cairn/optimization/object_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/median.h"
#include "cairn/geometry/parallax.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFirstLambda = 1e-3, kLeastLambda = 1e-9, kLargestLambda = 1e12;
constexpr double kFaster = 3, kSlower = 4;    // by which lambda falls and grows
constexpr double kEnough = 1e-5;              // a smaller relative gain ends it
constexpr double kLeastDamping = 1e-6;        // of the largest diagonal number
constexpr double kLeastConditioning = 1e-13;  // of a normal matrix with a diagonal of ones
constexpr double kSigmaRotation = 1;          // radians: turned by half a turn it is the same
constexpr double kNoBox = 1000;               // σ: that a view errs where the thing has no outline

bool is_finite(const Ellipsoid& e) { return e.T.is_finite() && e.semi_axes.allFinite(); }

// Gauss and Newton's: half of the cost's second and first derivatives.
struct NormalEquations {
  Matrix9d H = Matrix9d::Zero();
  Vector9d g = Vector9d::Zero();

  template <int Rows>
  void add(double weight, const Eigen::Matrix<double, Rows, 9>& J,
           const Eigen::Matrix<double, Rows, 1>& e) {
    H.noalias() += weight * J.transpose() * J;
    g.noalias() += weight * J.transpose() * e;
  }
};

class Problem {
 public:
  Problem(std::span<const BoxView> views, const Pinhole& pinhole, const ObjectPrior& prior,
          const ObjectFitOptions& options)
      : views_(views), pinhole_(pinhole), prior_(prior), options_(options) {}

  bool robust() const { return options_.form == FactorForm::kRobust; }

  // Infinite where the form has none. `normal` may be null.
  double cost(const Ellipsoid& e, NormalEquations* normal) const {
    if (normal) *normal = {};
    double sum = robust() ? prior_cost(e, normal) : 0;
    for (const BoxView& view : views_) {
      sum += robust() ? robust_cost(e, view, normal) : paper_cost(e, view, normal);
      if (!std::isfinite(sum)) return kInfinite;
    }
    return sum;
  }

  Ellipsoid moved(const Ellipsoid& e, const Vector9d& step) const {
    const Vector3d last = step.tail<3>();
    return {e.T * SE3::exp(step.head<6>()), robust()
                                                ? Vector3d(e.semi_axes.array() * last.array().exp())
                                                : Vector3d(e.semi_axes + last)};
  }

  std::optional<Box2> prediction(const Ellipsoid& e, const BoxView& view,
                                 BoxByEllipsoid* derivative = nullptr) const {
    return projected_box(pinhole_, {view.T_cw * e.T, e.semi_axes}, derivative);
  }

 private:
  double robust_cost(const Ellipsoid& e, const BoxView& view, NormalEquations* normal) const {
    BoxByEllipsoid J;
    const double width = options_.loss * options_.loss;
    const auto box = prediction(e, view, normal ? &J : nullptr);
    // A guess of a table may reach behind a camera above it: the other views mend that.
    if (!box) return view.weight * width * std::log1p(kNoBox * kNoBox / width);
    Vector4d error = (box->edges() - view.box.edges()) / view.sigma;
    for (int i = 0; i < 4; ++i) {
      // The thing goes on beyond a cut edge; how far, the picture does not say.
      if (!view.cut[std::size_t(i)] || (i < 2 ? error[i] > 0 : error[i] < 0)) continue;
      error[i] = 0;
      if (normal) J.row(i).setZero();
    }
    const double ratio = error.squaredNorm() / width;
    if (normal) {
      J /= view.sigma;
      normal->add<4>(view.weight / (1 + ratio), J, error);
    }
    return view.weight * width * std::log1p(ratio);
  }

  double paper_cost(const Ellipsoid& e, const BoxView& view, NormalEquations* normal) const {
    BoxByEllipsoid by_ellipsoid;
    Eigen::RowVector4d by_edges = Eigen::RowVector4d::Zero();
    const auto box = prediction(e, view, normal ? &by_ellipsoid : nullptr);
    const double iou =
        box ? intersection_over_union(*box, view.box, normal ? &by_edges : nullptr) : 0;
    if (normal && box) {
      // The box's derivative is by the logarithms of the semi-axes.
      by_ellipsoid.rightCols<3>() *= e.semi_axes.cwiseInverse().asDiagonal();
      normal->add<1>(view.weight, -by_edges * by_ellipsoid, Eigen::Matrix<double, 1, 1>(1 - iou));
    }
    return view.weight * (1 - iou) * (1 - iou);
  }

  double prior_cost(const Ellipsoid& e, NormalEquations* normal) const {
    const Vector3d logs = e.semi_axes.array().log();
    const Vector3d shape = logs.array() - logs.mean();
    double sum = 0;
    const auto add = [&](double sigma, const Vector3d& error, const Matrix3d& by_logs) {
      if (!(sigma > 0) || std::isinf(sigma)) return;
      sum += error.squaredNorm() / (sigma * sigma);
      if (!normal) return;
      normal->H.bottomRightCorner<3, 3>() += by_logs / (sigma * sigma);  // a projector
      normal->g.tail<3>() += error / (sigma * sigma);
    };
    const Matrix3d identity = Matrix3d::Identity();
    Matrix3d by_turn;
    const Vector3d turn = turn_residual(prior_, e.T.rotation(), &by_turn);
    sum += turn.squaredNorm();
    if (normal) {
      normal->H.block<3, 3>(3, 3) += by_turn.transpose() * by_turn;
      normal->g.segment<3>(3) += by_turn.transpose() * turn;
    }
    if (prior_.ground) {
      Eigen::Matrix<double, 1, 9> by_step;
      const Eigen::Matrix<double, 1, 1> gap(
          ground_residual(prior_, e, normal ? &by_step : nullptr));
      sum += gap.squaredNorm();
      if (normal) normal->add<1>(1, by_step, gap);
    }
    add(prior_.sigma_shape, shape - prior_.shape, identity - Matrix3d::Constant(1.0 / 3));
    if (prior_.usual > 0) {
      const Vector3d usual = prior_.shape.array() + std::log(prior_.usual);
      add(prior_.sigma_size, logs - usual, identity);
    }
    return sum;
  }

  std::span<const BoxView> views_;
  const Pinhole& pinhole_;
  const ObjectPrior& prior_;
  const ObjectFitOptions& options_;
};

Vector9d damped_step(const NormalEquations& normal, double lambda) {
  const Vector9d diagonal = normal.H.diagonal();
  Matrix9d damped = normal.H;
  damped.diagonal().array() +=
      lambda * (diagonal.array() + kLeastDamping * diagonal.maxCoeff()) + 1e-12;
  return -damped.ldlt().solve(normal.g);
}

// Levenberg and Marquardt's method from `fit.ellipsoid`, whose cost is finite.
void minimise(const Problem& problem, int max_steps, NormalEquations& normal, ObjectFit& fit) {
  double lambda = kFirstLambda;
  while (fit.steps < max_steps && lambda <= kLargestLambda) {
    ++fit.steps;
    const Ellipsoid next = problem.moved(fit.ellipsoid, damped_step(normal, lambda));
    const double cost = problem.cost(next, nullptr);
    if (!(cost < fit.cost)) {
      lambda *= kSlower;
      continue;
    }
    const bool done = fit.cost - cost < kEnough * fit.cost;
    fit.ellipsoid = next;
    fit.cost = problem.cost(next, &normal);
    lambda = std::max(lambda / kFaster, kLeastLambda);
    if (done) return;
  }
}

// The inverse, scaled so that metres, radians and ratios weigh alike. False where there is none.
bool invert(const Matrix9d& H, Matrix9d& covariance) {
  Matrix9d information = H;
  // No box shows how a ball is turned.
  information.diagonal().segment<3>(3).array() += 1 / (kSigmaRotation * kSigmaRotation);
  if (!(information.diagonal().minCoeff() > 0) || !information.allFinite()) return false;
  const Vector9d scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix9d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::LDLT<Matrix9d> ldlt(scaled);
  if (!(ldlt.vectorD().minCoeff() > kLeastConditioning)) return false;
  const Matrix9d inverse = ldlt.solve(Matrix9d::Identity());
  covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  return covariance.allFinite();
}

// How well the boxes of the result agree with those seen.
void judge(const Problem& problem, std::span<const BoxView> views, double loss, ObjectFit& fit) {
  std::vector<double> largest;  // errors, pixels
  largest.reserve(views.size());
  std::vector<Vector3d> eyes;  // of the views that agree
  eyes.reserve(views.size());
  for (const BoxView& view : views) {
    const auto box = problem.prediction(fit.ellipsoid, view);
    double error = -1;  // of no edge
    for (std::size_t i = 0; i < 4; ++i) {
      if (view.cut[i]) continue;
      const int k = int(i);
      error = std::max(error, box ? std::abs(box->edges()[k] - view.box.edges()[k]) : kInfinite);
    }
    if (box && error <= loss * view.sigma) {
      ++fit.agreeing;
      eyes.push_back(view.T_cw.inverse().translation());
    }
    if (error >= 0) largest.push_back(error);
  }
  fit.median_error = largest.empty() ? 0 : median(largest);
  fit.span = largest_parallax(eyes, fit.ellipsoid.centre());
}

bool usable_input(const Ellipsoid& start, std::span<const BoxView> views) {
  if (views.empty() || !is_finite(start) || !(start.semi_axes.minCoeff() > 0)) return false;
  return std::all_of(views.begin(), views.end(), [](const BoxView& v) {
    return v.T_cw.is_finite() && v.box.valid() && v.sigma > 0 && std::isfinite(v.sigma) &&
           v.weight >= 0 && std::isfinite(v.weight);
  });
}

}  // namespace

std::string ObjectFit::to_string() const {
  char text[160];
  std::snprintf(text, sizeof text,
                "%s of %d boxes, %d agreeing over %.1f deg: median %.2f px, cost %.4g in %d steps",
                usable ? "ellipsoid" : "no ellipsoid", views, agreeing, span * 180 / M_PI,
                median_error, cost, steps);
  return text;
}

ObjectFit fit_object(const Ellipsoid& start, std::span<const BoxView> views, const Pinhole& pinhole,
                     const ObjectPrior& prior, const ObjectFitOptions& options) {
  ObjectFit fit;
  fit.ellipsoid = start;
  fit.views = int(views.size());
  if (!usable_input(start, views)) return fit;
  const Problem problem(views, pinhole, prior, options);
  NormalEquations normal;
  fit.cost = problem.cost(start, &normal);
  if (!std::isfinite(fit.cost)) return fit;
  minimise(problem, options.max_steps, normal, fit);
  fit.ellipsoid.semi_axes = fit.ellipsoid.semi_axes.cwiseAbs();  // the paper's form has no sign
  judge(problem, views, options.loss, fit);
  if (problem.robust()) {
    fit.usable = is_finite(fit.ellipsoid) && invert(normal.H, fit.covariance);
  } else {
    // As long as no box overlaps there is no way down.
    double worst = 0;
    for (const BoxView& view : views) worst += view.weight;
    fit.usable = is_finite(fit.ellipsoid) && fit.cost < worst;
  }
  return fit;
}

}  // namespace cairn
