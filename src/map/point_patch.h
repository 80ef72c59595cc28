#pragma once

#include <memory>
#include <optional>

#include "cairn/features/image_pyramid.h"
#include "cairn/features/patch.h"
#include "cairn/geometry/se3.h"
#include "cairn/map/frame.h"

namespace cairn {

/// A picture that is at hand.
struct Picture {
  ImagePyramid pyramid;
  const Undistorter* lens = nullptr;  ///< it was taken through; outlives the picture
};

/// What a point of the map looks like: a small facet, as a camera saw it.
struct PointPatch {
  Patch patch;
  Eigen::Vector3d ray;  ///< from the camera to the point, world
  /// What the camera saw `u` pixels from the middle, along rows and down columns, is
  /// steps * u / (1 + foreshortening . u) from the point, in the world.
  Eigen::Matrix<double, 3, 2> steps;
  Eigen::Vector2d foreshortening = Eigen::Vector2d::Zero();

  /// Of the facet, unit length, world; its sign is of no matter.
  Eigen::Vector3d normal() const { return steps.col(0).cross(steps.col(1)).normalized(); }
  /// The same picture on a facet that lies otherwise; as it was where that was seen from the edge.
  PointPatch turned(const Eigen::Vector3d& normal) const;
};

/// What a point at `position` (world) looks like in a picture that shows it at `pixel` (of the
/// ideal pinhole camera, but where its row saw it), on a facet that faces the camera; none where
/// that is too near to the border.
std::shared_ptr<const PointPatch> cut_patch(const Picture& picture, const Pinhole& pinhole,
                                            const Eigen::Vector2d& pixel, int octave,
                                            const SE3& T_wc, const Eigen::Vector3d& position);

/// Where near `pixel` (as above) a picture, taken at about T_cw, looks as the point did.
std::optional<Eigen::Vector2d> find_patch(const PointPatch& patch, const Picture& picture,
                                          const Pinhole& pinhole, const SE3& T_cw,
                                          const Eigen::Vector3d& position,
                                          const Eigen::Vector2d& pixel);

}  // namespace cairn
