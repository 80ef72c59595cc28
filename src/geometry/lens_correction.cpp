#include "cairn/geometry/lens_correction.h"

#include <cmath>

namespace cairn {
namespace {

constexpr int kSteps = 4;  // of a fixed point: corrections are small

}  // namespace

Eigen::Vector2d LensCorrection::project(const Pinhole& pinhole, const Eigen::Vector3d& X,
                                        Eigen::Matrix<double, 2, 3>* by_point,
                                        Eigen::Matrix<double, 2, kSize>* by_values) const {
  const auto [a, k1, k2, dx, dy] = values;
  const double zi = 1.0 / X.z(), x = X.x() * zi, y = X.y() * zi;
  const double r2 = x * x + y * y, d = 1 + r2 * (k1 + r2 * k2);
  const double focal = std::exp(a), fx = pinhole.fx * focal, fy = pinhole.fy * focal;
  if (by_point != nullptr) {
    const double slope = 2 * (k1 + 2 * k2 * r2);  // d d / d r², times two
    const Eigen::Matrix2d J{{fx * (d + slope * x * x), fx * slope * x * y},
                            {fy * slope * x * y, fy * (d + slope * y * y)}};
    const Eigen::Matrix<double, 2, 3> plane{{zi, 0, -x * zi}, {0, zi, -y * zi}};
    *by_point = J * plane;
  }
  if (by_values != nullptr) {
    *by_values << fx * x * d, fx * x * r2, fx * x * r2 * r2, 1, 0,  //
        fy * y * d, fy * y * r2, fy * y * r2 * r2, 0, 1;
  }
  return {fx * x * d + pinhole.cx + dx, fy * y * d + pinhole.cy + dy};
}

Eigen::Vector2d LensCorrection::ideal(const Pinhole& pinhole, const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d at = pixel;
  for (int i = 0; i < kSteps; ++i) at += pixel - project(pinhole, pinhole.unproject(at));
  return at;
}

}  // namespace cairn
