#pragma once

#include <vector>

#include "cairn/geometry/minimum_enclosing_ellipsoid.h"
#include "cairn/synthetic/scene.h"

namespace cairn {

/// What a map should know about an object in the end. World frame, metres.
struct ObjectTruth {
  int thing = 0;                                  ///< index into Scene::things
  EnclosingEllipsoid ellipsoid;                   ///< of least volume around its surface
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< its symmetry is about this axis
  std::vector<Eigen::Vector3d> surface_points;    ///< evenly spread over its surface
};

/// Of all objects of a scene, by index of the thing. The same scene gives the same points.
std::vector<ObjectTruth> object_truths(const Scene& scene, int points = 500);

}  // namespace cairn
