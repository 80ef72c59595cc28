#include "cairn/optimization/depth_blocks.h"

#include <algorithm>
#include <cmath>

#include "cairn/map/independent_pictures.h"
#include "cairn/optimization/pose_blocks.h"

namespace cairn {
namespace {

constexpr int kDepthsAKeyframe = 20;  // what a picture predicts errs alike all over it
constexpr double kLeastError = 1e-3;

// By how much the errors of pictures that err alike weigh more than those of independent ones.
double alike(std::vector<double> times) {
  const double pictures = double(times.size());
  return std::sqrt(pictures / independent_pictures(std::move(times)));
}

}  // namespace

void DepthBlocks::add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering,
                         std::span<const Sight> sights, bool full) {
  full_ = full;
  log_units_ = std::log(map_.units_a_metre);
  struct Picture {
    int known = 0, passed = 0;
    bool speaks = false;
  };
  std::vector<Picture> pictures;  // by slot
  std::vector<double> times;
  for (const Sight& s : sights) {
    if (s.keyframe.slot >= pictures.size()) pictures.resize(s.keyframe.slot + 1);
    if (!(depth_of(s) > 0)) continue;
    Picture& picture = pictures[s.keyframe.slot];
    if (!picture.speaks) times.push_back(map_.keyframes()[s.keyframe].timestamp());
    picture.speaks = true;
    picture.known += !assumed(s);
  }
  if (times.empty()) return;
  const double share = alike(std::move(times));
  for (const Sight& s : sights) {
    const double depth = depth_of(s);
    if (!(depth > 0)) continue;
    const Keyframe& keyframe = map_.keyframes()[s.keyframe];
    const double local = std::max(keyframe.sigma_depth, kLeastError);
    if (assumed(s)) {  // nothing else says how far it is
      add(problem, s, depth, share * std::hypot(local, keyframe.sigma_depth_scale));
      continue;
    }
    // A few a keyframe, as unsure together as the one scale of the picture.
    Picture& picture = pictures[s.keyframe.slot];
    const int n = std::min(picture.known, kDepthsAKeyframe);
    const int i = picture.passed++;
    if (i * n / picture.known == (i + 1) * n / picture.known) continue;
    add(problem, s, depth, share * std::hypot(local, std::sqrt(n) * keyframe.sigma_depth_scale));
  }
  ordering.AddElementToGroup(&log_units_, kScaleGroup);
  if (!full) problem.SetParameterBlockConstant(&log_units_);
}

double DepthBlocks::depth_of(const Sight& sight) const {
  const Keyframe& keyframe = map_.keyframes()[sight.keyframe];
  if (keyframe.depth.empty()) return 0;
  return stretched_depth(keyframe.depth[sight.keypoint], keyframe.depth_range, map_.depth_contrast);
}

void DepthBlocks::add(ceres::Problem& problem, const Sight& sight, double depth, double sigma) {
  factors_.emplace_back(depth, options_.sigma * sigma);
  problem.AddResidualBlock(&factors_.back(), nullptr, sight.T_wc, sight.position, &log_units_);
}

void DepthBlocks::scale(double factor) { log_units_ += std::log(factor); }

void DepthBlocks::write_back(Map& map) const {
  if (full_ && !factors_.empty()) map.units_a_metre = std::exp(log_units_);
}

}  // namespace cairn
