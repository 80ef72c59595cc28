#pragma once

#include <Eigen/Core>
#include <cmath>

namespace cairn {

/// The log map of the sphere in N + 1 dimensions at its last axis: of x = (v, w), |x| = 1, w ≥ 0,
/// the arc from (0, 1) to x, which has the direction of v and the length of the angle between the
/// two, radians. `by_x`, may be null: its derivative. Finite for x = 0, too.
template <int N>
Eigen::Matrix<double, N, 1> sphere_log(const Eigen::Matrix<double, N + 1, 1>& x,
                                       Eigen::Matrix<double, N, N + 1>* by_x) {
  const Eigen::Matrix<double, N, 1> v = x.template head<N>();
  const double w = x[N], s = v.norm();
  const bool near = s < 1e-4;  // series, where s would divide by almost nothing
  const double k = near ? 1 + s * s / 6 : std::atan2(s, w) / s;
  if (by_x != nullptr) {
    const double c = near ? -2.0 / 3 : (w - k) / (s * s);
    by_x->template leftCols<N>() =
        k * Eigen::Matrix<double, N, N>::Identity() + c * v * v.transpose();
    by_x->col(N) = -v;
  }
  return k * v;
}

}  // namespace cairn
