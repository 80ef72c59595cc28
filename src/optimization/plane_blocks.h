#pragma once

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/factor_options.h"
#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/pose_blocks.h"

namespace cairn {

/// The planes of the map as parameters of an adjustment, with all factors that they take part in.
/// Keyframes and points that the adjustment does not move hold the planes all the same.
class PlaneBlocks {
 public:
  /// Where an adjustment keeps a point's position; null: it does not.
  using PointBlock = std::function<double*(PointId)>;

  PlaneBlocks(const Map& map, const PlaneFactorOptions& options) : map_(map), options_(options) {}

  /// Takes part with the planes that a keyframe of the adjustment sees, or some of its points lie
  /// on. What it adds to the problem is its own, and must outlive the problem's use, as `poses`
  /// must.
  void add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering, PoseBlocks& poses,
              const PointBlock& point_of);
  /// Where a plane is kept, for factors of others; null: it takes no part.
  double* block_of(PlaneId id);
  /// After a change of the map's unit.
  void scale(double factor);
  void write_back(Map& map) const;

 private:
  struct Entry {
    PlaneId id;
    std::array<double, 4> values;
  };

  bool takes_part(const PlaneLandmark& landmark) const;
  void add_observations(Entry& entry);
  void add_points(Entry& entry);
  void add_relations();
  const FactorOptions& options_of(PlaneRelation relation) const;
  std::unique_ptr<ceres::CostFunction> factor_of(const RelatedPlanes& related) const;
  double* held_point(PointId id);
  Entry* find(PlaneId id);
  void add(std::unique_ptr<ceres::CostFunction> factor, ceres::LossFunction* loss,
           const std::vector<double*>& blocks);

  const Map& map_;
  PlaneFactorOptions options_;
  ceres::Problem* problem_ = nullptr;
  ceres::ParameterBlockOrdering* ordering_ = nullptr;
  PoseBlocks* poses_ = nullptr;
  PointBlock point_of_;
  std::vector<Entry> planes_;  // reserved before they are filled, as all groups: see BlockGroup
  std::vector<Eigen::Vector3d> held_points_;
  std::vector<std::unique_ptr<ceres::CostFunction>> factors_;
  std::vector<std::unique_ptr<ceres::LossFunction>> losses_;
  PlaneManifold plane_manifold_;
};

}  // namespace cairn
