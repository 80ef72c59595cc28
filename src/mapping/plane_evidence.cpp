#include "cairn/mapping/plane_evidence.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "cairn/geometry/sampler.h"

namespace cairn {
namespace {

constexpr int kStarts = 40;        // half of the points on the plane: 99.5 % of finding it
constexpr int kFewPoints = 6;      // fewer decide by themselves nothing
constexpr double kMinSine = 0.05;  // of three points: nearer to a line they are no plane

}  // namespace

// Unknowns: turns of the normal about u and v, and a shift along it, at a place.
struct PlaneEvidence::Step {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
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
  for (const PlanePoint& p : points_) {
    const Eigen::Vector3d j(s.u.dot(p.position - at), s.v.dot(p.position - at), -1);
    const double off = plane.signed_distance(p.position);
    const double sigma = p.sigma_off(plane), ratio = off / (width * sigma);
    const double weight = 1 / (1 + ratio * ratio) / (sigma * sigma);
    s.H += weight * j * j.transpose();
    s.g += weight * off * j;
  }
  return s;
}

Plane PlaneEvidence::descend(Plane plane, double width) const {
  const Eigen::Vector3d middle = places_.col(3).head<3>() / std::max(places_(3, 3), 1e-300);
  constexpr int kSteps = 3;
  while (true) {
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d n = plane.normal(), at = middle - plane.signed_distance(middle) * n;
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
    cost += std::log1p(ratio * ratio);
  }
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

std::optional<Plane> PlaneEvidence::solve(const Plane& start) const {
  const double width = points_.empty() || !(place_weight_ > 0)
                           ? 1
                           : 1 / std::sqrt(place_weight_) / points_[points_.size() / 2].sigma;
  Plane best = descend(start, width);
  double least = cost(best);
  Sampler sampler(points_.size());
  const int n = static_cast<int>(points_.size());
  std::optional<Plane> other;
  for (int i = 0; n >= kFewPoints && i < kStarts; ++i) {
    const auto [a, b, c] = sampler.distinct<3>(n);
    const Eigen::Vector3d ab = points_[b].position - points_[a].position;
    const Eigen::Vector3d ac = points_[c].position - points_[a].position;
    Eigen::Vector3d normal = ab.cross(ac);
    if (!(normal.norm() > kMinSine * ab.norm() * ac.norm())) continue;
    normal.normalize();
    if (normal.dot(normals_) < 0) normal = -normal;
    const Plane candidate = Plane::through(points_[a].position, normal);
    const double candidate_cost = cost(candidate);
    if (candidate_cost >= least) continue;
    other = candidate;
    least = candidate_cost;
  }
  if (other) best = descend(*other, 1);
  return std::isfinite(cost(best)) ? std::optional(best) : std::nullopt;
}

double PlaneEvidence::sigma_angle(const Plane& plane, const Eigen::Vector3d& at) const {
  const Eigen::Matrix3d covariance = step(plane, at, 1).H.inverse();
  return std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
}

double PlaneEvidence::sigma_place(const Plane& plane, const Eigen::Vector3d& at) const {
  return std::sqrt(step(plane, at, 1).H.inverse()(2, 2));
}

}  // namespace cairn
