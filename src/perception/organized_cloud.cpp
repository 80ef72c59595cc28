#include "cairn/perception/organized_cloud.h"

#include <cmath>

namespace cairn {

cv::Mat_<cv::Vec3f> viewing_rays(const Camera& camera, const cv::Size& grid) {
  constexpr double kLeastForward = 0.1;  // cosine to the optical axis; beyond, depth says nothing
  cv::Mat_<cv::Vec3f> rays(grid, cv::Vec3f());
  const double step_x = double(camera.width()) / grid.width;
  const double step_y = double(camera.height()) / grid.height;
  for (int v = 0; v < grid.height; ++v) {
    for (int u = 0; u < grid.width; ++u) {
      const Eigen::Vector3d ray =
          camera.unproject({(u + 0.5) * step_x - 0.5, (v + 0.5) * step_y - 0.5});
      if (!ray.allFinite() || ray.z() < kLeastForward) continue;
      rays(v, u) = {float(ray.x() / ray.z()), float(ray.y() / ray.z()), 1.f};
    }
  }
  return rays;
}

}  // namespace cairn
