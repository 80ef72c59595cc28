#pragma once

#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// How the surfaces lie that a keyframe sees, as its points show it: on a plane the inverse of the
/// depth is affine in the pixel, so an affine function through a point and its neighbours in the
/// picture gives the normal there. Neighbours say as much as the parallax of their views makes them
/// sure of their depth; those on other surfaces are let go as outliers.
class SurfaceNormals {
 public:
  SurfaceNormals(const Map& map, const Keyframe& keyframe);

  /// At a keypoint that sees a point; world, unit length. Facing the camera where neighbours are
  /// few.
  Eigen::Vector3d at(std::uint32_t keypoint) const;

 private:
  struct Sample {
    double x, y, inverse_depth;  ///< x, y at depth 1
    double noise;                ///< of the depth, relative
  };
  const Keyframe& keyframe_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> index_;  ///< a keypoint: of its sample
};

}  // namespace cairn
