#pragma once

// The association room: which detection is which landmark. It decides and changes nothing.

#include <span>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

struct PlaneAssociationOptions {
  int th_high = 12;  ///< shared keypoints that make two planes one
  int th_low = 4;    ///< fewer make them two; between the two nothing is decided
  // However unsure both are; where their σ are small, three σ are the limit.
  double max_angle_deg = 30;  ///< between the normals
  double max_offset = 0.2;    ///< at the centroid, as a share of its distance from the camera
  double point_sigma = 0.01;  ///< of a point off its plane, as a share of its viewing distance
};

/// What a detected plane is: one of the map, a new one, or neither for certain.
struct PlaneDecision {
  enum class Kind { kKnown, kNew, kUnclear };
  Kind kind = Kind::kNew;
  PlaneId plane = {};  ///< where it is known
};

/// One decision a detected plane (the paper, section IV.B). A detection is the landmark with which
/// it shares most keypoints, if these are at least th_high and the two agree in normal and offset.
/// Otherwise it is the landmark that it lies on and touches, if there is one; else new below
/// th_low, and unclear above.
std::vector<PlaneDecision> associate_planes(const Map& map, KeyframeId keyframe,
                                            std::span<const SeenPlane> seen,
                                            const PlaneAssociationOptions& options);

/// A plane of the map, in the frame of the camera that may see it.
struct KnownPlane {
  PlaneId id;
  Plane plane;  ///< positive on the side that pictures show
  std::vector<Eigen::Vector3d> outline;
  double sigma_tilt = 0;  ///< of its normal, radians

  /// From frame a to frame b.
  KnownPlane transformed(const SE3& T_ba) const;
};

/// Of the planes that what was seen agrees with in normal and offset, and that it touches, the one
/// that it agrees with best; null where there is none.
const KnownPlane* nearest_surface(const SeenPlane& seen, std::span<const KnownPlane> known,
                                  const PlaneAssociationOptions& options);

/// Do two landmarks agree in normal and offset, and touch or overlap? Offsets are judged at both
/// outlines' middles, as shares of `distance` (units of the map).
bool one_surface(const Map& map, PlaneId a, PlaneId b, double distance,
                 const PlaneAssociationOptions& options);

}  // namespace cairn
