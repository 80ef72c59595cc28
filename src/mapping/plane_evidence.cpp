#include "cairn/mapping/plane_evidence.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

constexpr int kStarts = 40;    // half of the points on the plane: 99.5 % of finding it
constexpr int kFewPoints = 6;  // fewer decide by themselves nothing
// How likely a point is anywhere else, to being right on the plane. Surfaces hide what is behind
// them: a point there is a mistake, before them only a thing.
constexpr double kElsewhere = 0.01, kBehind = 0.0016;
constexpr double kOdds = 6;        // twenty to one, twice its logarithm
constexpr double kMinSine = 0.05;  // of three points: nearer to a line they are no plane

}  // namespace

// Unknowns: turns of the normal about u and v, and a shift along it, at a place.
struct PlaneEvidence::Step {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d information;  // of what is far off the plane far less than it pulls
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  Eigen::Vector3d u, v;
};

void PlaneEvidence::add_normal(const Eigen::Vector3d& normal, double sigma) {
  normals_ += normal / (sigma * sigma);
  normal_weight_ += 1 / (sigma * sigma);
}

void PlaneEvidence::add_direction(const Eigen::Vector3d& direction, double sigma) {
  directions_ += direction * direction.transpose() / (sigma * sigma);
}

void PlaneEvidence::add_place(const Eigen::Vector3d& place, double sigma) {
  const Eigen::Vector4d h = place.homogeneous();
  places_ += h * h.transpose() / (sigma * sigma);
  place_weight_ += 1 / (sigma * sigma);
}

PlaneEvidence::Step PlaneEvidence::step(const Plane& plane, const Eigen::Vector3d& at,
                                        double width) const {
  const Eigen::Vector3d n = plane.normal();
  Step s;
  s.u = n.unitOrthogonal();
  s.v = n.cross(s.u);
  Eigen::Matrix<double, 4, 3> J;  // of (n, d)
  J << s.u, s.v, Eigen::Vector3d::Zero(), -s.u.dot(at), -s.v.dot(at), -1;
  const Eigen::Vector4d h(n.x(), n.y(), n.z(), plane.offset());
  const auto turns = J.topRows<3>();
  s.H = J.transpose() * places_ * J + turns.transpose() * directions_ * turns;
  s.g = J.transpose() * places_ * h + turns.transpose() * directions_ * n;
  s.H.diagonal().head<2>().array() += normal_weight_;
  s.g.head<2>() -= Eigen::Vector2d(s.u.dot(normals_), s.v.dot(normals_));
  s.information = s.H;
  for (const PlanePoint& p : points_) {
    const Eigen::Vector3d j(s.u.dot(p.position - at), s.v.dot(p.position - at), -1);
    const double off = plane.signed_distance(p.position);
    const double sigma = p.sigma_off(plane), ratio = off / (width * sigma);
    const double share = 1 / (1 + ratio * ratio), weight = p.worth * share / (sigma * sigma);
    s.H += weight * j * j.transpose();
    s.information += share * weight * j * j.transpose();
    s.g += weight * off * j;
  }
  return s;
}

// Of the middle of what pictures show, on a plane.
Eigen::Vector3d PlaneEvidence::foot(const Plane& plane) const {
  const Eigen::Vector3d middle = places_.col(3).head<3>() / std::max(places_(3, 3), 1e-300);
  return middle - plane.signed_distance(middle) * plane.normal();
}

PlaneEvidence PlaneEvidence::without_points() const {
  PlaneEvidence pictures = *this;
  pictures.points_.clear();
  return pictures;
}

Plane PlaneEvidence::descend(Plane plane, double width) const {
  constexpr int kSteps = 3;
  while (true) {
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d n = plane.normal(), at = foot(plane);
      const Step s = step(plane, at, std::max(width, 1.0));
      const Eigen::Vector3d x = s.H.ldlt().solve(-s.g);
      plane = Plane::through(at + x[2] * n, (n + x[0] * s.u + x[1] * s.v).normalized());
    }
    if (width <= 1) return plane;
    width /= 2;
  }
}

double PlaneEvidence::cost(const Plane& plane) const {
  const Eigen::Vector3d n = plane.normal();
  const Eigen::Vector4d h(n.x(), n.y(), n.z(), plane.offset());
  double cost =
      h.dot(places_ * h) + n.dot(directions_ * n) + 2 * (normals_.norm() - normals_.dot(n));
  for (const PlanePoint& p : points_) {
    const double ratio = plane.signed_distance(p.position) / p.sigma_off(plane);
    cost -=
        2 * p.worth * std::log(std::exp(-ratio * ratio / 2) + (ratio < 0 ? kBehind : kElsewhere));
  }
  cost += std::log(step(plane, foot(plane), 1).information.determinant());
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

std::optional<PlaneFit> PlaneEvidence::solve(const Plane& start) const {
  const bool pictured = place_weight_ > 0 && normal_weight_ > 0;
  const double width = points_.empty() || !pictured
                           ? 1
                           : 1 / std::sqrt(place_weight_) / points_[points_.size() / 2].sigma;
  Plane best = descend(start, 1);
  double least = cost(best);
  const auto offer = [&](const Plane& candidate) {
    const double candidate_cost = cost(candidate);
    if (!(candidate_cost < least)) return false;
    best = candidate;
    least = candidate_cost;
    return true;
  };
  offer(descend(start, width));
  Sampler sampler(points_.size());
  const int n = static_cast<int>(points_.size());
  bool sampled = false;
  for (int i = 0; n >= kFewPoints && i < kStarts; ++i) {
    const auto [a, b, c] = sampler.distinct<3>(n);
    const Eigen::Vector3d ab = points_[b].position - points_[a].position;
    const Eigen::Vector3d ac = points_[c].position - points_[a].position;
    Eigen::Vector3d normal = ab.cross(ac);
    if (!(normal.norm() > kMinSine * ab.norm() * ac.norm())) continue;
    normal.normalize();
    if (normal.dot(normals_) < 0) normal = -normal;
    sampled |= offer(Plane::through(points_[a].position, normal));
  }
  if (sampled) {
    best = descend(best, 1);
    least = cost(best);
  }
  if (pictured) {
    const PlaneEvidence pictures = without_points();
    const Plane alone = pictures.descend(start, 1);
    double worth = 0;
    for (const PlanePoint& p : points_) worth += p.worth;
    const double points_anywhere = pictures.cost(alone) - 2 * worth * std::log(kElsewhere);
    if (!(least < points_anywhere - kOdds) && std::isfinite(points_anywhere)) {
      return PlaneFit{alone, false};
    }
  }
  return std::isfinite(least) ? std::optional(PlaneFit{best}) : std::nullopt;
}

Eigen::Matrix3d PlaneEvidence::covariance(const PlaneFit& fit, const Eigen::Vector3d& at) const {
  const Step s = fit.by_points ? step(fit.plane, at, 1) : without_points().step(fit.plane, at, 1);
  return s.information.inverse();
}

double PlaneEvidence::sigma_angle(const PlaneFit& fit, const Eigen::Vector3d& at) const {
  const Eigen::Matrix3d c = covariance(fit, at);
  return std::sqrt(std::max(c(0, 0), c(1, 1)));
}

double PlaneEvidence::sigma_place(const PlaneFit& fit, const Eigen::Vector3d& at) const {
  return std::sqrt(covariance(fit, at)(2, 2));
}

}  // namespace cairn
