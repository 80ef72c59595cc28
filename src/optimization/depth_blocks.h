#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <deque>
#include <span>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/factor_options.h"
#include "cairn/optimization/factors/predicted_depth_factor.h"
#include "cairn/optimization/factors/two_rows.h"

namespace cairn {

/// What pictures say of the depth of points in an adjustment, and the unit of the map that follows
/// (docs/factors/predicted_depth.md).
class DepthBlocks {
 public:
  /// A point as a keyframe sees it, and where the adjustment keeps the two.
  struct Sight {
    KeyframeId keyframe;
    PointId point;
    std::uint32_t keypoint;
    double* T_wc;
    double* position;
  };

  DepthBlocks(const Map& map, const FactorOptions& options) : map_(map), options_(options) {}

  /// Is there anything to add?
  bool wanted() const { return options_.use && map_.units_a_metre > 0; }
  /// Where wanted(), in the order of `sights`. Only a full adjustment finds the unit; others hold
  /// it. What it adds to the problem is its own, and must outlive the problem's use.
  void add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering,
              std::span<const Sight> sights, bool full);
  /// After a change of the map's unit.
  void scale(double factor);
  void write_back(Map& map) const;

 private:
  double depth_of(const Sight& sight) const;
  bool assumed(const Sight& sight) const { return map_.points()[sight.point].assumed; }
  void add(ceres::Problem& problem, const Sight& sight, double depth, double sigma);

  const Map& map_;
  FactorOptions options_;
  bool full_ = false;
  double log_units_ = 0;  // of the map a metre
  std::deque<TwoRows<PredictedDepthFactor>> factors_;
};

}  // namespace cairn
