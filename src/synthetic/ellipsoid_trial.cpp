#include "cairn/synthetic/ellipsoid_trial.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kNoise = 2, kOutlierNoise = 30;  // of an edge, pixels
constexpr double kOutlierShare = 0.1;
constexpr double kCutMargin = 3;                                                // pixels
constexpr double kAimNoise = 0.08, kStartNoise = 0.06, kDisplacedNoise = 0.15;  // metres
constexpr double kTurnedAway = 3;  // metres beside the thing that a camera aims at, at most
constexpr int kTurnedAwayViews = 6;

// All numbers of a trial, drawn in the order of the specification whether used or not.
class Draws {
 public:
  struct Camera {
    double distance = 0, elevation = 0;
    Vector3d aim;
    Vector4d edges, outlier_edges;  // of unit variance
    bool outlier = false;
    double score = 0, outlier_score = 0;
    int side = 0;         // on which the picture cuts the thing off: left, top, right, bottom
    double cut_away = 0;  // the share of its box
    bool turned_away = false;
  };

  explicit Draws(std::uint64_t seed) : sampler_(seed) {
    const Vector4d q = normals<4>();
    truth.T = SE3(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), Vector3d::Zero());
    for (double& axis : truth.semi_axes) {
      axis = EllipsoidTrial::kUsualAxis * std::exp(sampler_.uniform() - 0.5);
    }
    for (Camera& camera : cameras) draw(camera);
    std::array<double, EllipsoidTrial::kViews> lot;
    for (double& number : lot) number = sampler_.uniform();
    std::array<int, EllipsoidTrial::kViews> order;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return lot[std::size_t(a)] < lot[std::size_t(b)]; });
    for (int i = 0; i < kTurnedAwayViews; ++i) {
      cameras[std::size_t(order[std::size_t(i)])].turned_away = true;
    }
    start_centre = normals<3>();
    start_radius = normal();
  }

  Ellipsoid truth;
  std::array<Camera, EllipsoidTrial::kViews> cameras;
  Vector3d start_centre;    // of unit variance
  double start_radius = 0;  // likewise

 private:
  double normal() {  // Box and Muller
    const double u = 1 - sampler_.uniform(), v = sampler_.uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
  }

  template <int N>
  Eigen::Matrix<double, N, 1> normals() {
    Eigen::Matrix<double, N, 1> numbers;
    for (double& number : numbers) number = normal();
    return numbers;
  }

  void draw(Camera& camera) {
    camera.distance = 1.2 + 0.6 * sampler_.uniform();
    camera.elevation = (20 + 10 * (sampler_.uniform() - 0.5)) * M_PI / 180;
    camera.aim = kAimNoise * normals<3>();
    camera.edges = normals<4>();
    camera.score = 0.85 + 0.08 * normal();
    camera.outlier = sampler_.uniform() < kOutlierShare;
    camera.outlier_edges = normals<4>();
    camera.outlier_score = 0.6 + 0.15 * normal();
    camera.side = int(4 * sampler_.uniform());
    camera.cut_away = 0.2 + 0.3 * sampler_.uniform();
  }

  Sampler sampler_;
};

// A level camera: rows of the rotation are right, down, forward.
SE3 looking(const Vector3d& from, const Vector3d& at) {
  const Vector3d forward = (at - from).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Matrix3d R;
  R << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  return SE3(R, -(R * from));
}

std::optional<Box2> true_box(const SE3& T_cw, const Ellipsoid& truth) {
  return projected_box(EllipsoidTrial::kPinhole, {T_cw * truth.T, truth.semi_axes});
}

// The share of the thing's box that is outside of the picture.
double share_outside(const SE3& T_cw, const Ellipsoid& truth) {
  const auto box = true_box(T_cw, truth);
  if (!box) return 1;
  const Box2 inside = box->clipped(EllipsoidTrial::kPicture);
  return inside.valid() ? 1 - inside.area() / box->area() : 1;
}

// Turns a camera until the border cuts off as much as was drawn.
SE3 turned_away(const Vector3d& from, const Draws::Camera& camera, const Ellipsoid& truth) {
  const Matrix3d R = looking(from, camera.aim).matrix3();
  const Vector3d aside = (camera.side < 2 ? 1 : -1) * R.row(camera.side % 2).transpose();
  double low = 0, high = kTurnedAway;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const bool too_far =
        share_outside(looking(from, camera.aim + middle * aside), truth) > camera.cut_away;
    (too_far ? high : low) = middle;
  }
  return looking(from, camera.aim + (low + high) / 2 * aside);
}

void observe(const Draws::Camera& camera, const Ellipsoid& truth, bool outlier,
             EllipsoidTrial::View& view) {
  const auto box = true_box(view.T_cw, truth);
  if (!box) return;
  const Vector4d e = box->edges() + (outlier ? Vector4d(kOutlierNoise * camera.outlier_edges)
                                             : Vector4d(kNoise * camera.edges));
  const Box2 sorted{std::min(e[0], e[2]), std::min(e[1], e[3]), std::max(e[0], e[2]),
                    std::max(e[1], e[3])};
  view.box = sorted.clipped(EllipsoidTrial::kPicture);
  const Vector4d border = EllipsoidTrial::kPicture.edges();
  for (int i = 0; i < 4; ++i) {
    view.cut[std::size_t(i)] = std::abs(view.box.edges()[i] - border[i]) <= kCutMargin;
  }
  view.score = std::clamp(outlier ? camera.outlier_score : camera.score, 0.3, 1.0);
}

}  // namespace

EllipsoidTrial make_ellipsoid_trial(std::uint64_t seed, double span_deg, TrialWorld world) {
  const Draws draws(seed);
  EllipsoidTrial trial;
  trial.truth = draws.truth;
  for (int i = 0; i < EllipsoidTrial::kViews; ++i) {
    const Draws::Camera& camera = draws.cameras[std::size_t(i)];
    const double azimuth = (double(i) / (EllipsoidTrial::kViews - 1) - 0.5) * span_deg * M_PI / 180;
    const double level = std::cos(camera.elevation);
    const Vector3d from =
        camera.distance *
        Vector3d(level * std::cos(azimuth), level * std::sin(azimuth), std::sin(camera.elevation));
    EllipsoidTrial::View& view = trial.views[std::size_t(i)];
    const bool away = world == TrialWorld::kTruncated && camera.turned_away;
    view.T_cw = away ? turned_away(from, camera, trial.truth) : looking(from, camera.aim);
    observe(camera, trial.truth, world == TrialWorld::kOutliers && camera.outlier, view);
  }
  const double off = world == TrialWorld::kDisplaced ? kDisplacedNoise : kStartNoise;
  trial.start.T = SE3(Eigen::Quaterniond::Identity(), off * draws.start_centre);
  trial.start.semi_axes.setConstant(EllipsoidTrial::kUsualAxis *
                                    std::exp(0.3 * draws.start_radius));
  return trial;
}

}  // namespace cairn
