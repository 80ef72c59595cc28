#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/depth_blocks.h"
#include "cairn/optimization/factors/lens_point_factor.h"
#include "cairn/optimization/factors/number_prior.h"
#include "cairn/optimization/factors/point_factor.h"
#include "cairn/optimization/factors/rolling_point_factor.h"
#include "cairn/optimization/factors/unit_factor.h"
#include "cairn/optimization/map_adjustment.h"
#include "cairn/optimization/object_blocks.h"
#include "cairn/optimization/odometry_blocks.h"
#include "cairn/optimization/plane_blocks.h"
#include "cairn/optimization/point_losses.h"
#include "cairn/optimization/pose_blocks.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {

/// A part of the map as a least-squares problem: contiguous parameters, filled from the map,
/// written back to it.
class MapProblem {
 public:
  /// The keyframes that move, those that are held, and the points. `width`: of the cores of points'
  /// errors, times theirs. `full`: it is the whole map. `refine_lens`: its correction moves, too.
  MapProblem(Map& map, std::vector<KeyframeId> free, std::vector<KeyframeId> fixed,
             std::vector<PointId> points, const AdjustmentOptions& options, double width = 1,
             bool full = false, bool refine_lens = false);

  AdjustmentSummary solve(int iterations, double tolerance, const StopAsked& stop);
  void hold_steps(OdometryBlocks& odometry);
  /// The unit of a monocular map is free: keyframes and points can shrink together at no cost, and
  /// steps along that direction are as large as the solver's damping lets them be. What hangs on
  /// the keyframes by lengths (frames, buried keyframes) stays behind; so the unit is kept: the
  /// spread of the keyframes around the one that is held. To be called before write_back.
  void keep_unit();
  void write_back();
  /// Erases the observations that lie beyond the gate; to be called after write_back.
  int erase_outliers(double gate);

 private:
  struct Edge {
    std::uint32_t keyframe, point, keypoint;
    bool aligned;
  };

  void build();
  Eigen::Vector2d drift(const Edge& edge) const;
  void add_depths();
  double* pose_of(KeyframeId id);
  void add_landmarks();
  void hold_unit();
  void collect();

  Map& map_;
  bool full_;
  int threads_;
  bool refine_lens_;
  LensCorrection lens_;
  bool estimate_readout_;
  double readout_;
  NumberPrior readout_prior_;
  std::vector<KeyframeId> keyframes_;  // the free ones first
  std::size_t free_count_ = 0;
  std::vector<PointId> points_;
  std::vector<int> index_of_slot_;
  std::vector<Edge> observations_;
  std::vector<double> pose_values_, point_values_;
  std::deque<PointFactor> factors_;
  std::deque<LensPointFactor> lens_factors_;
  std::deque<RollingPointFactor> rolling_factors_;
  LensPriorFactor lens_prior_;
  std::unique_ptr<UnitFactor> unit_;
  std::optional<PoseBlocks> poses_;
  DepthBlocks depths_;
  PlaneBlocks planes_;
  ObjectBlocks objects_;
  PointLosses losses_;
  SE3Manifold manifold_;
  std::unique_ptr<ceres::Problem> problem_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
};

}  // namespace cairn
