#pragma once

#include <Eigen/Core>
#include <vector>

#include "cairn/geometry/se3.h"

namespace cairn {

/// A way along straight lines with rounded corners, travelled at a speed that drops in the corners.
class Route {
 public:
  struct Speed {
    double straight = 1, corner = 0.7;  ///< metres a second
  };
  Route(std::vector<Eigen::Vector2d> corners, double radius, const Speed& speed);

  /// Seconds from end to end.
  double duration() const { return 0.01 * double(reached_.size() - 1); }
  /// Where one is after `t` seconds (beyond the ends: straight on).
  Eigen::Vector2d at(double t) const;
  /// The direction of travel, radians from +x.
  double heading(double t) const;

 private:
  Eigen::Vector2d on_line(double s) const;
  double corner_distance(double s) const;

  std::vector<Eigen::Vector2d> points_;  // arcs in short pieces
  std::vector<double> lengths_;          // up to each point
  std::vector<double> turns_;            // middles of corners, as lengths
  double radius_;
  std::vector<double> reached_;  // metres after each hundredth of a second
};

}  // namespace cairn
