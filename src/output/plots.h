#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cairn/geometry/ellipsoid.h"
#include "cairn/geometry/trajectory.h"
#include "cairn/output/map_ply.h"

namespace cairn {

/// The axes of a view from above: right and forward on paper, and up out of it. A right-handed
/// frame of unit vectors in the world.
struct PlanView {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  std::string right_name = "x", forward_name = "z", up_name = "-y";

  /// For the world of a monocular map, the first camera (x right, y down, z forward).
  static PlanView first_camera() { return {}; }
  /// For worlds with z against gravity.
  static PlanView z_up();
  /// Finds the coordinate axis that is up: the one nearest to the mean of "up" in the pictures. So
  /// maps, KITTI (y down) and TUM (z up) are drawn as a person expects.
  static PlanView from_cameras(const Trajectory& trajectory);
};

/// What the plots are drawn from. All in one world frame.
struct PlotScene {
  Trajectory estimate;  ///< with a ground truth: aligned to it
  Trajectory truth;     ///< may be empty
  Trajectory keyframes;
  std::vector<Eigen::Vector3d> points;
  std::vector<Rgb> point_colours;  ///< of each point; empty: by height
  struct PlaneOutline {
    std::vector<Eigen::Vector3d> outline;
    std::string label;
    Rgb colour;
  };
  std::vector<PlaneOutline> planes;
  struct Object {
    Ellipsoid ellipsoid;
    std::string label;
    Rgb colour;
  };
  std::vector<Object> objects;
  PlanView view;
  std::string title;       ///< the sequence
  std::string unit = "m";  ///< of lengths; "map units" where the scale is free
};

/// The path from above, and its height over time.
cv::Mat draw_trajectory_plot(const PlotScene& scene);
/// The points from above with planes, objects and the path of the keyframes. Far outliers are left
/// out.
cv::Mat draw_map_plot(const PlotScene& scene);
/// Distances between estimate and truth over time, with their RMSE. `timestamps` in seconds,
/// `errors` in metres.
cv::Mat draw_error_plot(std::span<const double> timestamps, std::span<const double> errors,
                        const std::string& title);

/// Throws Error(kOutput).
void write_png(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace cairn
