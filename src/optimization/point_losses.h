#pragma once

#include <ceres/loss_function.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// The losses of points' errors: Cauchy's, and for the sightings of what belongs to one landmark
/// times a weight. A patch of a surface without relief is found where it is; one that shows several
/// things, or whose facet is not known, is off, and so are those beside it, which no residual
/// shows.
class PointLosses {
 public:
  /// `width`: half of that of the core, in σ.
  explicit PointLosses(double width) : usual_(width) {}
  PointLosses(const PointLosses&) = delete;
  PointLosses& operator=(const PointLosses&) = delete;

  /// Weighs the aligned sightings of what is of a thing that is born, or else lies on a confirmed
  /// plane, by the square of how much more exactly they fit the map, in the median, than those of
  /// what is of neither.
  void weigh_landmarks(const Map& map);
  /// Of a sighting of a point. Lives as long as this.
  ceres::LossFunction* of(PointId point, bool aligned);

 private:
  ceres::CauchyLoss usual_;
  std::vector<std::unique_ptr<ceres::LossFunction>> of_groups_;
  std::vector<std::uint16_t> group_of_slot_;
};

}  // namespace cairn
