#include "cairn/optimization/pose_blocks.h"

namespace cairn {

PoseBlocks::PoseBlocks(const Map& map, ceres::Problem& problem,
                       ceres::ParameterBlockOrdering& ordering, Own own)
    : map_(map), problem_(problem), ordering_(ordering), own_(std::move(own)) {
  held_.reserve(map.keyframes().size());
}

double* PoseBlocks::at(KeyframeId id) {
  if (double* block = own_(id)) return block;
  for (const auto& [held, block] : held_of_) {
    if (held == id) return block;
  }
  double* block = held_.emplace_back().data();
  SE3Manifold::pack(map_.keyframes()[id].T_wc, block);
  held_of_.emplace_back(id, block);
  problem_.AddParameterBlock(block, 7, &manifold_);
  problem_.SetParameterBlockConstant(block);
  ordering_.AddElementToGroup(block, kHeldPoseGroup);
  return block;
}

}  // namespace cairn
