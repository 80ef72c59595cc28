#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cairn/evaluation/found_landmarks.h"
#include "cairn/geometry/camera.h"

namespace cairn {

/// What may have been measured of a plane of the map, and when that is enough.
struct MeasuredPlaneOptions {
  double max_distance = 0.3;     ///< metres from the plane of the map
  double max_turn_deg = 45;      ///< between it and the measured surface around a point
  double rim = 0.05;             ///< of the root of its area, at its outline: the least sure part
  double gate = 0.05;            ///< metres from the measured plane to the points that lie on it
  std::size_t min_points = 200;  ///< on the measured plane
  int pixel_step = 8;            ///< every so many pixels, each way, one is taken
};

/// A plane of the map beside the one that a depth sensor measured in its place.
struct MeasuredPlane {
  int id = 0;
  std::string label;
  std::size_t points = 0;           ///< that lie on the measured plane
  double share = 0;                 ///< of all points that may be of it
  std::optional<double> angle_deg;  ///< between the normals; none: not measured
  std::optional<double> offset;     ///< metres, from the middle of the outline; none: not measured
};

struct MeasuredPlaneReport {
  std::size_t pictures = 0;
  std::vector<MeasuredPlane> planes;        ///< all of the map
  std::optional<double> angle_deg, offset;  ///< medians over those that are measured
};

/// Collects what a depth sensor measured at known poses around the planes of a map, and fits planes
/// to it.
class MeasuredPlanes {
 public:
  /// `planes`: in the world of the poses, metres.
  explicit MeasuredPlanes(std::vector<FoundPlane> planes, const MeasuredPlaneOptions& options = {});

  /// `depth`: CV_32F, metres along the axis of `camera`, of its size, 0 where unknown.
  void add(const cv::Mat& depth, const Camera& camera, const SE3& T_wc);
  MeasuredPlaneReport report() const;

 private:
  void add_point(const Eigen::Vector3d& x, const Eigen::Vector3d& normal);
  MeasuredPlane measure(std::size_t plane) const;

  MeasuredPlaneOptions options_;
  std::vector<FoundPlane> planes_;
  std::vector<double> rims_;                          // metres, one a plane
  std::vector<std::vector<Eigen::Vector3d>> points_;  // one list a plane
  std::size_t pictures_ = 0;
};

/// measured_planes.{pictures, measured, angle_deg, offset, planes}, of each plane {id, label,
/// points, share, angle_deg, offset}; null where there is no figure.
nlohmann::json to_json(const MeasuredPlaneReport& report);

/// A table for people.
std::string to_table(const MeasuredPlaneReport& report);

}  // namespace cairn
