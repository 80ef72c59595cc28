#include "cairn/synthetic/ray_table.h"

#include <tbb/parallel_for.h>

namespace cairn {

RayTable::RayTable(const Camera& camera)
    : camera_(camera),
      stride_(std::size_t(camera.width()) + 2),
      rays_(stride_ * (std::size_t(camera.height()) + 2)),
      pixel_angle_(float(1 / camera.pinhole().fx)) {
  tbb::parallel_for(-1, camera.height() + 1, [&](int y) {
    for (int x = -1; x <= camera.width(); ++x) {
      rays_[std::size_t(y + 1) * stride_ + std::size_t(x + 1)] =
          camera.unproject({x, y}).cast<float>();
    }
  });
}

bool RayTable::is_of(const Camera& camera) const {
  const auto &a = camera_.pinhole(), &b = camera.pinhole();
  return camera.model() == camera_.model() && camera.width() == camera_.width() &&
         camera.height() == camera_.height() && camera.distortion() == camera_.distortion() &&
         a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

}  // namespace cairn
