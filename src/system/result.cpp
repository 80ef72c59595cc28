#include "cairn/system/result.h"

#include <algorithm>
#include <vector>

namespace cairn {

ReprojectionError reprojection_error(const Map& map) {
  std::vector<double> errors;
  map.points().for_each([&](PointId, const MapPoint& point) {
    for (const Observation& o : point.observations) {
      const Keyframe& keyframe = map.keyframes()[o.keyframe];
      const Eigen::Vector3d X = keyframe.T_wc.inverse() * point.position;
      const Eigen::Vector2d at = map.lens().project(map.view().pinhole(), X);
      errors.push_back((at - keyframe.frame->pixel(o.keypoint)).norm());
    }
  });
  ReprojectionError result;
  result.observations = errors.size();
  if (errors.empty()) return result;
  const auto quantile = [&](double q) {
    const auto nth = errors.begin() + static_cast<std::ptrdiff_t>(q * double(errors.size() - 1));
    std::nth_element(errors.begin(), nth, errors.end());
    return *nth;
  };
  result.median_px = quantile(0.5);
  result.p75_px = quantile(0.75);
  result.p95_px = quantile(0.95);
  return result;
}

}  // namespace cairn
