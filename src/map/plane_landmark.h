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
  std::vector<std::uint32_t> inner;      ///< those of them that are far from its rim
  std::vector<std::uint32_t> beside;     ///< of the keyframe, just outside of the mask
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
  /// Of each part that it sees, keyframe's frame; the rays of corners tell, not how far they are.
  std::vector<std::vector<Eigen::Vector3d>> outlines = {};
  std::vector<std::uint32_t> keypoints = {}, inner = {}, beside = {};  ///< as in SeenPlane
};

/// How often a point was well inside of a plane's mask, at its rim, just outside of it, and farther
/// outside, in pictures that show both.
struct MaskVotes {
  int inside = 0, rim = 0, beside = 0, outside = 0;

  MaskVotes& operator+=(const MaskVotes& other);
};

/// Points in the masks of a plane, in order of ids: well inside of them; or also at their rims,
/// where what stands in front is likely; or also just outside, as masks are rough.
struct MaskedPoints {
  std::vector<PointId> inner, all, near;
};

/// What a keyframe saw of a plane: its frame in that of the plane's reference, and outlines in its
/// frame, as in PlaneObservation.
struct PlaneOutlines {
  SE3 T_rk;
  std::vector<std::vector<Eigen::Vector3d>> outlines;
};

/// A plane of the map, relative to the keyframe that saw it first (the paper, section III.B).
struct PlaneLandmark {
  KeyframeId reference;
  Plane plane;                                      ///< in the reference's frame
  std::map<std::string, double> votes = {};         ///< for each label: sum of scores
  std::vector<PlaneObservation> observations = {};  ///< one a keyframe, in order of arrival
  std::vector<PointId> points = {};                 ///< map points that lie on it
  // What keyframes saw that are gone.
  std::map<PointId, MaskVotes> buried_votes = {};
  std::vector<PlaneOutlines> buried_views = {};
  std::vector<Eigen::Vector3d> outline = {};  ///< convex hull, in the reference's frame
  std::uint32_t sightings = 0;                ///< pictures that showed it, ever
  std::uint32_t last_seen = 0;                ///< sequence number of the last of them to come
  // Evidence, kept by mapping.
  double sigma_tilt = 3.2;  ///< of its normal, radians
  /// Points in its masks whose depth is sure enough to tell; those before it count half.
  double judges = 0;
  double share = 0;  ///< of these, those that lie on it
  /// Share of the keyframes that see its points in which it was detected; 1 where none sees enough.
  double detected = 0;
  /// How far its points lie off it, robustly (1.48 times the median), as a share of their viewing
  /// distance: surfaces are not flat, and things lie on them.
  double spread = 1;
  /// How far from flat it is by what its points' observations say, a share of the viewing distance.
  /// Of those that are confirmed only: points of others are not held to them.
  double roughness = 1;
  bool denied = false;  ///< most pictures of others say that, by its label, it cannot stand so
  /// What its observations are worth: pictures that follow each other err alike.
  double independent = 1;
  bool confirmed = false;  ///< enough pictures, and enough points that pile up on it

  bool seen_by(KeyframeId keyframe) const;
  /// One observation a keyframe: what more it sees of the plane only widens the first.
  void add(const PlaneObservation& o);
  /// The label that most pictures gave it; of equal ones the first by name.
  const std::string& label() const;
};

/// Moves a landmark to another reference; `T_nr`: old reference to new.
void change_reference(PlaneLandmark& landmark, KeyframeId reference, const SE3& T_nr);

/// Smallest convex polygon in the plane around the projections of all points (Andrew's monotone
/// chain), counter-clockwise seen from the side that the normal points to.
std::vector<Eigen::Vector3d> convex_outline(const Plane& plane,
                                            const std::vector<Eigen::Vector3d>& points);

/// Corners of frame a in frame b.
std::vector<Eigen::Vector3d> transformed(std::vector<Eigen::Vector3d> corners, const SE3& T_ba);

/// Corners seen from the origin, each moved along its ray onto the plane. Left out are those whose
/// rays miss it or graze it far beyond the others.
std::vector<Eigen::Vector3d> moved_along_rays(const std::vector<Eigen::Vector3d>& corners,
                                              const Plane& plane);

/// What keyframe k saw of a plane, on the plane; plane and result in the frame of its reference r,
/// corners in that of k.
std::vector<Eigen::Vector3d> outline_on(const Plane& plane, const SE3& T_rk,
                                        const std::vector<Eigen::Vector3d>& corners);

/// The outline of a plane that many pictures show: convex, around all their outlines but for what
/// only the widest twentieth of them shows in some direction.
std::vector<Eigen::Vector3d> common_outline(
    const Plane& plane, const std::vector<std::vector<Eigen::Vector3d>>& outlines);

/// The mean of an outline's corners; the origin where there are none.
Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3d>& outline);

/// From where a landmark was seen first to its middle, units of the map.
double viewing_distance(const PlaneLandmark& landmark);

enum class PlaneRelation { kParallel, kPerpendicular, kCoplanar };

/// How far the normals of two planes are from a relation, radians, whichever sides they face.
double angle_off(PlaneRelation relation, const Plane& a, const Plane& b);

/// Two planes of the map that the evidence says stand so to each other.
struct RelatedPlanes {
  PlaneId a, b;
  PlaneRelation relation = PlaneRelation::kParallel;
};

}  // namespace cairn
