#include "cairn/optimization/odometry_blocks.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

// How unsure the way of a second is, as tracking had it; it grows with the square root of time, so
// that a path is as firm with many keyframes as with few. Where many points say a step, they say it
// a hundred times better; where few do, a wrong one must not tear the path.
constexpr double kShareOfWay = 0.35;  // of the way that a camera goes in a second
constexpr double kTurn = 0.12;        // radians
constexpr double kLongestStep = 2;    // seconds

}  // namespace

OdometryBlocks::OdometryBlocks(const Map& map) {
  std::vector<std::pair<double, KeyframeId>> order;
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe& k) { order.emplace_back(k.timestamp(), id); });
  std::sort(order.begin(), order.end());
  struct Measured {
    KeyframeId a, b;
    SE3 T_ab;
    double dt;
  };
  std::vector<Measured> measured;
  double length = 0, time = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const double dt = order[i].first - order[i - 1].first;
    if (!(dt > 0 && dt <= kLongestStep)) continue;
    const KeyframeId a = order[i - 1].second, b = order[i].second;
    const SE3 T_ab = map.keyframes()[a].T_wc.inverse() * map.keyframes()[b].T_wc;
    measured.push_back({a, b, T_ab, dt});
    length += T_ab.translation().norm();
    time += dt;
  }
  if (!(length > 0)) return;  // nothing has moved: no length says how sure it is
  for (const Measured& m : measured) {
    // A camera may turn where it stands: no step is surer than the usual speed lets it be.
    const double speed = length / time + m.T_ab.translation().norm() / m.dt;
    const double root = std::sqrt(m.dt);
    steps_.emplace_back(m.a, m.b);
    factors_.emplace_back(m.T_ab, kShareOfWay * speed * root, kTurn * root);
  }
}

void OdometryBlocks::add_to(ceres::Problem& problem, const PoseBlocks::Own& pose_of) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    problem.AddResidualBlock(&factors_[i], nullptr, pose_of(steps_[i].first),
                             pose_of(steps_[i].second));
  }
}

}  // namespace cairn
