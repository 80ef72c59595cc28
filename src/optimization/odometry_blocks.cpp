#include "cairn/optimization/odometry_blocks.h"

#include <algorithm>

namespace cairn {
namespace {

// Of the step from one keyframe to the next, as tracking had it: where many points say it, they say
// it a hundred times better. Where few do, a wrong one must not tear the path.
constexpr double kShareOfStep = 0.3, kTurnOfStep = 0.05;  // of its length; radians
constexpr double kLongestStep = 2;                        // seconds

}  // namespace

OdometryBlocks::OdometryBlocks(const Map& map) {
  std::vector<std::pair<double, KeyframeId>> order;
  map.keyframes().for_each(
      [&](KeyframeId id, const Keyframe& k) { order.emplace_back(k.timestamp(), id); });
  std::sort(order.begin(), order.end());
  std::vector<SE3> measured;
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i].first - order[i - 1].first > kLongestStep) continue;
    const KeyframeId a = order[i - 1].second, b = order[i].second;
    steps_.emplace_back(a, b);
    measured.push_back(map.keyframes()[a].T_wc.inverse() * map.keyframes()[b].T_wc);
  }
  double usual = 0;
  for (const SE3& T_ab : measured) usual += T_ab.translation().norm() / double(measured.size());
  if (!(usual > 0)) {  // nothing has moved: no length says how sure it is
    steps_.clear();
    return;
  }
  // A camera may turn where it stands: no step is surer than the usual one lets it be.
  for (const SE3& T_ab : measured) {
    const double sigma = kShareOfStep * (usual + T_ab.translation().norm());
    factors_.emplace_back(T_ab, sigma, kTurnOfStep);
  }
}

void OdometryBlocks::add_to(ceres::Problem& problem, const PoseBlocks::Own& pose_of) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    problem.AddResidualBlock(&factors_[i], nullptr, pose_of(steps_[i].first),
                             pose_of(steps_[i].second));
  }
}

}  // namespace cairn
