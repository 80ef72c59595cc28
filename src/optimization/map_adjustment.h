#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cairn/map/map.h"
#include "cairn/optimization/factor_options.h"

namespace cairn {

class OdometryBlocks;

struct AdjustmentOptions {
  int window = 30;  ///< keyframes moved by a local adjustment
  int fixed = 30;   ///< keyframes that hold it, at most
  int local_iterations = 8;
  int full_iterations = 40;
  int full_threads = 1;  ///< with more, sums come out in an order that changes from run to run
  bool estimate_readout = true;  ///< how long a rolling shutter takes to read a picture
  bool weigh_landmarks = true;   ///< by how exactly each is seen, in the full adjustment
  PlaneFactorOptions planes;
  ObjectFactorOptions objects;
};

/// Asked after each step of an adjustment: true ends it, and the map is as good as the last
/// accepted step. May be null.
using StopAsked = std::function<bool()>;

struct AdjustmentSummary {
  bool usable = false;
  bool stopped = false;  ///< before it was done
  int keyframes = 0, points = 0, observations = 0, outliers = 0, iterations = 0;
  double initial_rms = 0, final_rms = 0;  ///< √(robust cost of all factors / observations)
  std::string to_string() const;
};

/// Adjusts the newest keyframes around `centre`, those that share most points with it, and all
/// points they see; keyframes outside that see the same points are held. Observations beyond the
/// gate of their χ² are erased from the map afterwards. What was added to corners takes no part:
/// it would double the time, and what it is good for, drift, shows in the whole map only.
AdjustmentSummary adjust_locally(Map& map, KeyframeId centre, const AdjustmentOptions& options,
                                 const StopAsked& stop);

/// Adjusts everything; the first keyframe is held, and so is the unit of the map, and where points
/// are few how keyframes lay to each other. Runs twice: once with all observations, once without
/// those that the first run shows to be wrong. `path`: how keyframes lay to each other, as tracking
/// had them; null: as they lie now. Where it is stopped nothing is erased.
AdjustmentSummary adjust_fully(Map& map, const AdjustmentOptions& options, const StopAsked& stop,
                               OdometryBlocks* path = nullptr);

/// Adjusts everything once more, after `adjust_fully`, together with the correction of the lens.
/// Only if the correction explains a share of the cost that noise does not, it is believed and
/// the map changed; else, or where it is stopped, the summary is not `usable`.
AdjustmentSummary refine_lens(Map& map, const AdjustmentOptions& options, const StopAsked& stop,
                              OdometryBlocks* path = nullptr);

}  // namespace cairn
