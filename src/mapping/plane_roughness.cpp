#include "cairn/mapping/plane_roughness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cairn/geometry/median.h"
#include "cairn/optimization/factors/point_factor.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

constexpr std::size_t kEnough = 200;  // points say all that there is to say
constexpr std::size_t kLeast = 10;    // points, fewer do not tell what of it they err
constexpr std::size_t kViews = 3;     // of a point that errs by as much as is computed

struct Offset {
  double along, variance;  // from the plane, and its own
};

// One step of least squares with Cauchy's weights leads to where the observations have a point.
std::optional<Offset> free_offset(const Map& map, const MapPoint& point, const Plane& plane) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (const Observation& o : point.observations) {
    const Keyframe& keyframe = map.keyframes()[o.keyframe];
    const Frame& frame = *keyframe.frame;
    const PointFactor factor(map.view().pinhole(), frame.pixel(o.keypoint),
                             map.view().core(frame.octave(o.keypoint), o.aligned()));
    std::array<double, 7> pose;
    SE3Manifold::pack(keyframe.T_wc, pose.data());
    const double* blocks[] = {pose.data(), point.position.data()};
    Eigen::Vector2d e;
    Eigen::Matrix<double, 2, 3, Eigen::RowMajor> J;
    double* jacobians[] = {nullptr, J.data()};
    factor.Evaluate(blocks, e.data(), jacobians);
    const double weight = 1 / (1 + e.squaredNorm());
    H += weight * J.transpose() * J;
    g += weight * J.transpose() * e;
  }
  const Eigen::Matrix3d covariance = H.inverse();
  const Eigen::Vector3d X = point.position - covariance * g;
  if (!X.allFinite()) return std::nullopt;
  const Eigen::Vector3d n = plane.normal();
  return Offset{plane.signed_distance(X), n.dot(covariance * n)};
}

}  // namespace

double plane_roughness(const Map& map, PlaneId id) {
  const Plane plane = map.plane_in_world(id);
  std::vector<PointId> points;
  for (const PointId p : map.planes()[id].points) {
    const MapPoint& point = map.points()[p];
    if (!point.assumed && point.observations.size() >= kViews) points.push_back(p);
  }
  std::vector<double> off, own;
  const std::size_t n = std::min(points.size(), kEnough);
  for (std::size_t i = 0; i < n; ++i) {
    const PointId p = points[i * points.size() / n];
    const auto offset = free_offset(map, map.points()[p], plane);
    if (!offset) continue;
    const double distance = map.viewing_distance(p);
    off.push_back(std::abs(offset->along) / distance);
    own.push_back(offset->variance / (distance * distance));
  }
  if (off.empty()) return 1;
  const double sigma = robust_sigma(off);
  return off.size() < kLeast ? sigma : std::sqrt(std::max(sigma * sigma - median(own), 0.0));
}

}  // namespace cairn
