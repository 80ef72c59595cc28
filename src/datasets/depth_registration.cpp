#include "cairn/datasets/depth_registration.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cairn {
namespace {

// Neighbours at unlike depths are moved apart by the distance between the lenses. Pixels of the
// colour picture by which each is widened, so that slanted surfaces do not show cracks.
constexpr double kMargin = 0.25;
constexpr double kNearest = 0.01;  // metres in front of the lens

}  // namespace

DepthRegistration::DepthRegistration(const Camera& colour, const Camera& depth,
                                     const SE3& T_color_depth)
    : colour_(colour), size_(depth.width(), depth.height()), T_color_depth_(T_color_depth) {
  rays_.reserve(std::size_t(size_.width + 1) * std::size_t(size_.height + 1));
  for (int v = 0; v <= size_.height; ++v) {
    for (int u = 0; u <= size_.width; ++u) {
      const Eigen::Vector3d ray = depth.unproject({u - 0.5, v - 0.5});
      rays_.push_back(T_color_depth.rotation() * (ray / ray.z()));
    }
  }
}

Eigen::Vector3d DepthRegistration::corner(int column, int row) const {
  return rays_[std::size_t(row) * std::size_t(size_.width + 1) + std::size_t(column)];
}

cv::Mat_<float> DepthRegistration::operator()(const cv::Mat_<float>& metres) const {
  assert(metres.size() == size_);
  cv::Mat_<float> result(colour_.height(), colour_.width(), 0.f);
  const Eigen::Vector3d& t = T_color_depth_.translation();
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const float z = metres(v, u);
      if (!(z > 0) || !std::isfinite(z)) continue;
      const Eigen::Vector3d first = z * corner(u, v) + t, last = z * corner(u + 1, v + 1) + t;
      if (!(std::min(first.z(), last.z()) > kNearest)) continue;
      const Eigen::Vector2d a = colour_.project(first), b = colour_.project(last);
      if (!a.allFinite() || !b.allFinite()) continue;
      const Eigen::Array2d low = a.cwiseMin(b).array() - kMargin;
      const Eigen::Array2d high = a.cwiseMax(b).array() + kMargin;
      const Eigen::Array2d size(result.cols, result.rows);
      const Eigen::Array2i begin = low.ceil().max(0.0).min(size).cast<int>();
      const Eigen::Array2i end = (high.floor() + 1).max(0.0).min(size).cast<int>();
      const auto depth = static_cast<float>((first.z() + last.z()) / 2);
      for (int y = begin.y(); y < end.y(); ++y) {
        for (int x = begin.x(); x < end.x(); ++x) {
          float& seen = result(y, x);
          if (seen == 0 || depth < seen) seen = depth;
        }
      }
    }
  }
  return result;
}

}  // namespace cairn
