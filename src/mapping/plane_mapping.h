#pragma once

#include "cairn/association/plane_association.h"
#include "cairn/map/map.h"
#include "cairn/mapping/keyframe_perception.h"

namespace cairn {

struct PlaneMappingOptions {
  bool manhattan = false;         ///< parallel and perpendicular planes are found and bound
  int min_sightings = 5;          ///< pictures that a plane of the map must have
  int min_points = 6;             ///< of the map that must lie on it
  double max_tilt_sigma_deg = 5;  ///< how sure its normal must be
  double min_detected = 0.5;      ///< share of the keyframes of its points in which it was detected
  double min_share = 0.6;         ///< of the points in its masks that lie on it
  double max_spread = 0.02;       ///< of its points: those that only cross it are spread wider
  double probation = 4;           ///< seconds after its last sighting within which all this must be
  /// A keyframe with fewer measured points takes points from planes, without a second view.
  int few_points = 100;
  PlaneAssociationOptions association;
};

/// Map units a metre of the detector.
struct DepthScale {
  double here = 1;          ///< in this picture, as the map's points have it
  double everywhere = 1;    ///< as all pictures have it
  double sigma_here = 0.1;  ///< local errors of the detector's depth in this picture, relative
  double sigma_everywhere = 0.1;  ///< of this picture's depth against that of all
};

/// Takes the planes of a keyframe's picture into the map: decides which they are, lets the map's
/// points say where they lie, gathers the points on them, fuses and removes landmarks, and finds
/// which are parallel or perpendicular. Where the keyframe sees few points, keypoints on its planes
/// become points of the map by their planes' depth; these are returned.
std::vector<PointId> map_planes(Map& map, KeyframeId keyframe, const KeyframePerception& seen,
                                const DepthScale& scale, const PlaneMappingOptions& options);

/// Makes landmarks that turn out to be one surface one.
void fuse_planes(Map& map, const PlaneAssociationOptions& options);

}  // namespace cairn
