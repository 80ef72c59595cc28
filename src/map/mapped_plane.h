#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace cairn {

/// A plane of a finished map, for people and files: normal · x + d = 0 in the world.
struct MappedPlane {
  int id = 0;
  std::string label;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double d = 0;
  std::vector<Eigen::Vector3d> outline;                ///< corners in order, on the plane
  double sigma_angle = 0;                              ///< radians, of the normal
  int points = 0;                                      ///< of the map that lie on it
  int sightings = 0;                                   ///< pictures that showed it
  std::vector<double> seen;                            ///< seconds: keyframes that observe it
  std::vector<int> parallel, perpendicular, coplanar;  ///< ids of planes that it is bound to
};

}  // namespace cairn
