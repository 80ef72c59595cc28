#include "cairn/perception/normals.h"

#include <algorithm>
#include <cmath>

#include "cairn/perception/inverse_depth_fit.h"

namespace cairn {
namespace {

cv::Vec3f normal_at(const cv::Mat_<cv::Vec3f>& rays, const cv::Mat_<float>& depth,
                    const DepthNoise& noise, const NormalOptions& o, int v, int u) {
  const float z = depth(v, u);
  const int r = o.radius_px, window = (2 * r + 1) * (2 * r + 1);
  const float tolerance = float(o.max_step_sigmas * noise.sigma(z));
  const float slope = float(o.slope_share) * z;
  const Eigen::Vector3d centre(rays(v, u)[0], rays(v, u)[1], 1);
  InverseDepthFit fit;
  int used = 0;
  for (int y = std::max(0, v - r); y <= std::min(depth.rows - 1, v + r); ++y) {
    for (int x = std::max(0, u - r); x <= std::min(depth.cols - 1, u + r); ++x) {
      const float other = depth(y, x);
      const float allowed =
          std::max(tolerance, slope * float(std::max(std::abs(x - u), std::abs(y - v))));
      if (!(other > 0) || std::abs(other - z) > allowed) continue;
      // Shifted to the window's middle: the sums stay well conditioned.
      fit.add(rays(y, x)[0] - centre.x(), rays(y, x)[1] - centre.y(), 1.0 / other, 1);
      ++used;
    }
  }
  if (used < o.min_share * window) return {};
  const auto shifted = fit.solve();
  if (!shifted) return {};
  Eigen::Vector3d m = *shifted;
  m.z() -= m.x() * centre.x() + m.y() * centre.y();
  const double length = m.norm();
  // The surface at this pixel must face the camera; the fit of a ragged window may not.
  if (!(length > 0) || !(m.dot(centre) > 0)) return {};
  return {float(-m.x() / length), float(-m.y() / length), float(-m.z() / length)};
}

}  // namespace

cv::Mat_<cv::Vec3f> normals_from_depth(const cv::Mat_<cv::Vec3f>& rays,
                                       const cv::Mat_<float>& depth, const DepthNoise& noise,
                                       const NormalOptions& options) {
  CV_Assert(rays.size() == depth.size());
  cv::Mat_<cv::Vec3f> normals(depth.size(), cv::Vec3f());
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (depth(v, u) > 0) normals(v, u) = normal_at(rays, depth, noise, options, v, u);
    }
  }
  return normals;
}

}  // namespace cairn
