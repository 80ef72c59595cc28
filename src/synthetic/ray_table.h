#pragma once

#include <vector>

#include "cairn/geometry/camera.h"

namespace cairn {

/// The viewing rays of all pixels of a camera, worked out once: a lens is slow to invert.
class RayTable {
 public:
  explicit RayTable(const Camera& camera);

  /// The unit ray (camera frame) through a pixel's centre plus `offset` (pixels, at most half).
  Eigen::Vector3f ray(int x, int y, const Eigen::Vector2f& offset) const {
    const Eigen::Vector3f* at = &rays_[std::size_t(y + 1) * stride_ + std::size_t(x + 1)];
    const Eigen::Vector3f across = at[1] - at[-1], down = at[stride_] - *(at - stride_);
    return (at[0] + 0.5f * offset.x() * across + 0.5f * offset.y() * down).normalized();
  }
  /// Exactly through the centre.
  const Eigen::Vector3f& centre(int x, int y) const {
    return rays_[std::size_t(y + 1) * stride_ + std::size_t(x + 1)];
  }
  /// Between neighbours in the middle of the picture, radians.
  float pixel_angle() const { return pixel_angle_; }
  bool is_of(const Camera& camera) const;

 private:
  Camera camera_;
  std::size_t stride_;
  std::vector<Eigen::Vector3f> rays_;  // with a border of one pixel
  float pixel_angle_;
};

}  // namespace cairn
