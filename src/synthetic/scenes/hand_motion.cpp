#include "cairn/synthetic/scenes/hand_motion.h"

#include <cmath>

#include "cairn/geometry/sampler.h"

namespace cairn {

using Eigen::Vector3d;

SE3 looking_at(const Vector3d& position, const Vector3d& target, double roll) {
  const Vector3d z = (target - position).normalized();
  const Vector3d x = z.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R_wc;
  R_wc << x, z.cross(x), z;
  return SE3(Eigen::Quaterniond(R_wc) * so3_exp(Vector3d(0, 0, roll)), position);
}

double HandMotion::wander(double t, int channel, double period) const {
  Sampler sampler(seed_ * 64 + std::uint64_t(channel));
  double sum = 0;
  for (const double share : {1.0, 0.57, 0.31}) {
    const double phase = 2 * M_PI * sampler.uniform(), tuned = 0.9 + 0.2 * sampler.uniform();
    sum += std::pow(share, 1.3) * std::sin(2 * M_PI * t / (period * share * tuned) + phase);
  }
  return sum / 1.4;
}

SE3 HandMotion::tremble(double t, double strength) const {
  Vector6d xi;
  for (int i = 0; i < 3; ++i) {
    xi[i] = strength * (0.004 * wander(t, 40 + i, 0.9) + 0.0006 * wander(t, 46 + i, 0.15));
    xi[3 + i] = strength * (0.004 * wander(t, 43 + i, 0.8) + 0.0006 * wander(t, 49 + i, 0.13));
  }
  return SE3::exp(xi);
}

}  // namespace cairn
