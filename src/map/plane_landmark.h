#pragma once

#include <map>
#include <string>
#include <vector>

#include "cairn/geometry/plane.h"
#include "cairn/geometry/se3.h"
#include "cairn/map/ids.h"

namespace cairn {

/// A surface as one picture shows it, in the keyframe's frame and in units of the map.
struct SeenPlane {
  Plane plane;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of what is seen of it, on the plane
  double sigma_angle = 0.05;                           ///< radians, of the normal
  double sigma_offset = 0.05;                          ///< of the plane's distance at the centroid
  std::string label;
  double score = 1;                      ///< 0 to 1
  std::vector<std::uint32_t> keypoints;  ///< of the keyframe, inside the mask
  std::vector<Eigen::Vector3d> outline;  ///< corners of the seen part, in order, on the plane

  /// Where all lengths are multiplied by `factor`.
  SeenPlane scaled(double factor) const;
};

/// A keyframe's view of a plane, as the factors need it.
struct PlaneObservation {
  KeyframeId keyframe;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< keyframe's frame, unit
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< keyframe's frame, on the seen plane
  double sigma_angle = 0.05;                           ///< radians
  double sigma_offset = 0.05;                          ///< units of the map
};

/// A plane of the map, relative to the keyframe that saw it first (the paper, section III.B).
struct PlaneLandmark {
  KeyframeId reference;
  Plane plane;                                      ///< in the reference's frame
  std::map<std::string, double> votes = {};         ///< for each label: sum of scores
  std::vector<PlaneObservation> observations = {};  ///< one a keyframe, in order of arrival
  std::vector<PointId> points = {};                 ///< map points that lie on it
  std::vector<Eigen::Vector3d> outline = {};        ///< convex, in the reference's frame
  std::uint32_t sightings = 0;                      ///< pictures that showed it, ever
  std::uint32_t last_seen = 0;                      ///< sequence number of the newest of them
  // Evidence, kept by mapping.
  double sigma_tilt = 3.2;  ///< of its normal, radians
  /// How far its points lie off it, robustly (1.48 times the median), as a share of their viewing
  /// distance: surfaces are not flat, and things lie on them.
  double spread = 1;
  bool confirmed = false;  ///< enough pictures, and enough points that pile up on it

  bool seen_by(KeyframeId keyframe) const;
  /// The label that most pictures gave it; of equal ones the first by name.
  const std::string& label() const;
};

/// Moves a landmark to another reference; `T_nr`: old reference to new.
void change_reference(PlaneLandmark& landmark, KeyframeId reference, const SE3& T_nr);

/// Smallest convex polygon in the plane around the projections of all points (Andrew's monotone
/// chain), counter-clockwise seen from the side that the normal points to.
std::vector<Eigen::Vector3d> convex_outline(const Plane& plane,
                                            const std::vector<Eigen::Vector3d>& points);

/// The mean of an outline's corners; the origin where there are none.
Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& outline);

enum class PlaneRelation { kParallel, kPerpendicular };

/// Two planes of the map that the evidence says are parallel or perpendicular.
struct RelatedPlanes {
  PlaneId a, b;
  PlaneRelation relation = PlaneRelation::kParallel;
};

}  // namespace cairn
