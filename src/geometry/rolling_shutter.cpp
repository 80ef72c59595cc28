#include "cairn/geometry/rolling_shutter.h"

namespace cairn {

Eigen::Vector2d seen_at_once(const Pinhole& pinhole, const Eigen::Vector2d& pixel, double depth,
                             double moment, const Vector6d& motion) {
  // X_row in the camera of its row; T_mid_row = exp(moment * motion).
  const SE3 T_mid_row = SE3::exp(moment * motion);
  const Eigen::Vector3d X =
      T_mid_row.rotation() * pinhole.unproject(pixel) + T_mid_row.translation() / depth;
  return X.z() > 0 ? pinhole.project(X) : pixel;
}

}  // namespace cairn
