#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/factor_options.h"
#include "cairn/optimization/object_manifold.h"
#include "cairn/optimization/plane_blocks.h"
#include "cairn/optimization/pose_blocks.h"

namespace cairn {

/// The objects of the map as parameters of an adjustment, with all factors that they take part in.
/// Keyframes that the adjustment does not move hold the objects all the same.
class ObjectBlocks {
 public:
  ObjectBlocks(const Map& map, const ObjectFactorOptions& options) : map_(map), options_(options) {}

  /// Takes part with the born objects that a keyframe of the adjustment sees and another one, too.
  /// What it adds to the problem is its own, and must outlive the problem's use, as `poses` and
  /// `planes`, which is in the problem by now, must.
  void add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering, PoseBlocks& poses,
              PlaneBlocks& planes);
  /// After a change of the map's unit.
  void scale(double factor);
  void write_back(Map& map) const;

 private:
  struct Entry {
    ObjectId id;
    std::array<double, ObjectManifold::kAmbient> values;
  };

  bool takes_part(const ObjectLandmark& landmark) const;
  void add_observations(Entry& entry);
  void add_prior(Entry& entry);
  void add_support(Entry& entry, PlaneBlocks& planes);
  void add(std::unique_ptr<ceres::CostFunction> factor, ceres::LossFunction* loss,
           const std::vector<double*>& blocks);

  const Map& map_;
  ObjectFactorOptions options_;
  ceres::Problem* problem_ = nullptr;
  PoseBlocks* poses_ = nullptr;
  std::vector<Entry> objects_;  // reserved before they are filled: see BlockGroup
  std::vector<std::unique_ptr<ceres::CostFunction>> factors_;
  std::deque<ceres::ScaledLoss> box_losses_;  // one an object
  std::unique_ptr<ceres::LossFunction> box_loss_, support_loss_;
  ObjectManifold manifold_;
};

}  // namespace cairn
