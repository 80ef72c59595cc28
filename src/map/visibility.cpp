#include "cairn/map/visibility.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr double kMinCosine = 0.5;       // a patch looks different from more than 60° aside
constexpr double kRangeTolerance = 1.2;  // of the distances at which the pyramid sees a point

}  // namespace

Visibility predict_visibility(const View& view, const SE3& T_cw, const Eigen::Vector3d& camera_w,
                              const Eigen::Vector3d& position, const Eigen::Vector3f& normal,
                              float base_distance) {
  Visibility v;
  const Eigen::Vector3d X = T_cw * position;
  if (!(X.z() > 0)) return v;
  v.pixel = view.pinhole().project(X);
  if (!view.contains(v.pixel)) return v;
  const Eigen::Vector3d ray = position - camera_w;
  const double distance = ray.norm();
  const double top = view.scale(view.levels() - 1);
  if (distance > kRangeTolerance * base_distance ||
      distance * top * kRangeTolerance < base_distance) {
    return v;
  }
  v.cosine = ray.dot(normal.cast<double>()) / distance;
  if (v.cosine < kMinCosine) return v;
  const double octave = std::log(base_distance / distance) / view.log_scale_factor();
  v.octave = std::clamp(static_cast<int>(std::lround(octave)), 0, view.levels() - 1);
  v.visible = true;
  return v;
}

}  // namespace cairn
