#pragma once

#include <Eigen/Core>
#include <array>

#include "cairn/geometry/camera.h"

namespace cairn {

/// What a calibration gets wrong, as small changes to the ideal pinhole: the pixel of a point at
/// (x, y, 1) is f·exp(a)·(x, y)·(1 + k1 r² + k2 r⁴) + c + (dx, dy), r² = x² + y².
struct LensCorrection {
  static constexpr int kSize = 5;
  std::array<double, kSize> values{};  ///< a, k1, k2, dx [px], dy [px]

  bool is_identity() const { return values == std::array<double, kSize>{}; }

  /// The pixel of the point X (camera frame, z > 0), with its derivatives by X and by the values.
  Eigen::Vector2d project(const Pinhole& pinhole, const Eigen::Vector3d& X,
                          Eigen::Matrix<double, 2, 3>* by_point = nullptr,
                          Eigen::Matrix<double, 2, kSize>* by_values = nullptr) const;
  /// Where the ideal pinhole has what is seen at this pixel; to 0.01 px where the two are less than
  /// 20 px apart.
  Eigen::Vector2d ideal(const Pinhole& pinhole, const Eigen::Vector2d& pixel) const;
};

}  // namespace cairn
