#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// An object of a finished map, for people and files.
struct MappedObject {
  int id = 0;
  std::string class_name;
  double score = 0;           ///< mean of the detections', 0 to 1
  Ellipsoid ellipsoid;        ///< in the world
  Ellipsoid in_reference;     ///< in the frame of the keyframe that it is relative to
  double reference_time = 0;  ///< seconds, of that keyframe
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the centre, in the world
  int points = 0;                                        ///< of the map inside of it
  int sightings = 0;                                     ///< pictures that showed it
  std::vector<double> seen;                              ///< seconds: keyframes that observe it
  int plane = -1;  ///< id of the mapped plane that it stands on; -1: none
};

}  // namespace cairn
