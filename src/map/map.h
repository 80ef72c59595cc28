#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cairn/geometry/lens_correction.h"
#include "cairn/geometry/se3.h"
#include "cairn/map/covisibility.h"
#include "cairn/map/frame.h"
#include "cairn/map/ids.h"
#include "cairn/map/object_landmark.h"
#include "cairn/map/plane_landmark.h"
#include "cairn/map/point_patch.h"
#include "cairn/map/slot_map.h"

namespace cairn {

/// Of the logarithms of all depths that a network predicts in a picture; all 0: unknown.
struct DepthRange {
  double mean = 0, variance = 0;

  bool known() const { return mean != 0 || variance != 0; }
};

/// A frame that stays: its pose is optimised, its keypoints carry map points.
struct Keyframe {
  std::uint32_t sequence = 0;  ///< how many keyframes were made before it, ever
  std::shared_ptr<const Frame> frame;
  SE3 T_wc;                     ///< camera to world
  std::vector<PointId> points;  ///< one a keypoint; invalid where there is none
  /// What a network predicts, one a keypoint, metres, 0: unknown; empty where none has looked.
  std::vector<float> depth = {};
  DepthRange depth_range = {};   ///< of the whole picture as predicted
  double sigma_depth = 0;        ///< of its logarithm at one keypoint
  double sigma_depth_scale = 0;  ///< of the logarithm that all its keypoints share
  /// While it is new: points that it comes to see are aligned there.
  std::shared_ptr<const Picture> picture = {};

  double timestamp() const { return frame->timestamp; }
};

/// Does a keypoint lie where the picture looks as its point did before, or where a corner was
/// found?
enum class PatchState : std::uint8_t { kUntried, kFound, kMissed };

/// A keypoint of a keyframe that sees a map point.
struct Observation {
  KeyframeId keyframe;
  std::uint32_t keypoint = 0;
  PatchState patch = PatchState::kUntried;

  bool aligned() const { return patch == PatchState::kFound; }
};

struct MapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world, in units of the map
  Descriptor descriptor{};  ///< of all observations the one nearest to the others
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< mean direction camera to point, unit
  float base_distance = 0;  ///< distance at which it would show in octave 0
  std::vector<Observation> observations;
  std::uint32_t born = 0;                   ///< sequence number of the newest keyframe then
  std::uint32_t visible = 1, found = 1;     ///< frames that should have seen and saw it
  PackedColour colour;                      ///< of the keypoint that made it
  PlaneId plane;                            ///< on which it lies, if on one
  std::shared_ptr<const PointPatch> patch;  ///< what it looked like, if a picture was at hand
  bool assumed = false;  ///< its depth is that of its plane: no two views have measured it yet

  /// How a keyframe sees it; nullptr where it does not.
  const Observation* seen_from(KeyframeId keyframe) const;
  Observation* seen_from(KeyframeId keyframe);
};

/// Networks predict depths nearer to the mean of a picture than they are: predicted depth with the
/// range of its logarithms times `contrast`. What stays is the mean in metres, as it is depth that
/// networks blur, and not its logarithm. As it is where no range is known.
double stretched_depth(double depth, const DepthRange& range, double contrast);
/// The logarithm of stretched over predicted depth, where that of predicted depth is `from_mean`
/// above the mean of `range`.
double log_stretch(double from_mean, const DepthRange& range, double contrast);

/// Which way is up in the world of a map.
struct Upward {
  Eigen::Vector3d direction;
  double sigma;  ///< radians
};

/// Keyframes, points, planes and objects with their observations. Owned and changed by the mapper
/// alone.
class Map {
 public:
  explicit Map(const View& view) : view_(view) {}

  const View& view() const { return view_; }
  /// Units of the map a metre of the plane detector; 0 while nothing is known of it.
  double units_a_metre = 0;
  /// Units of the map a metre as the sizes of things say, 0 while they say nothing; only where the
  /// detector's metre is not to be trusted.
  std::optional<double> units_a_metre_by_sizes;
  /// Of the two the one to say how large things are.
  double units_a_true_metre() const { return units_a_metre_by_sizes.value_or(units_a_metre); }
  /// By how much predicted depths are to be stretched (see stretched_depth).
  double depth_contrast = 1;
  /// As far as planes or the way that the camera is held say it.
  std::optional<Upward> up;
  /// What the calibration got wrong, as far as it was estimated. Nothing until the full adjustment:
  /// tracking and mapping work with the calibration as given.
  const LensCorrection& lens() const { return lens_; }
  /// The boxes of all things move to where an ideal camera has them, if this is the lens.
  void set_lens(const LensCorrection& lens);
  /// Seconds that the shutter takes from the first row of a picture to the last; 0: so few that it
  /// may as well not roll.
  double readout() const { return readout_; }
  /// The same as the map's keyframes show it.
  double readout_estimate() const { return readout_estimate_; }
  /// Keyframes are made anew for which that makes a difference.
  void set_readout(double estimate);
  /// How a keyframe's camera moved, tangent vector in its own frame, a second: moves its keypoints
  /// to where an instant shutter would have seen them.
  void set_velocity(KeyframeId id, const Vector6d& velocity);
  SlotMap<Keyframe, KeyframeId>& keyframes() { return keyframes_; }
  const SlotMap<Keyframe, KeyframeId>& keyframes() const { return keyframes_; }
  SlotMap<MapPoint, PointId>& points() { return points_; }
  const SlotMap<MapPoint, PointId>& points() const { return points_; }

  SlotMap<PlaneLandmark, PlaneId>& planes() { return planes_; }
  const SlotMap<PlaneLandmark, PlaneId>& planes() const { return planes_; }
  /// Pairs of planes in order of ids; pairs of which a plane is erased go with it.
  std::vector<RelatedPlanes>& relations() { return relations_; }
  const std::vector<RelatedPlanes>& relations() const { return relations_; }

  SlotMap<ObjectLandmark, ObjectId>& objects() { return objects_; }
  const SlotMap<ObjectLandmark, ObjectId>& objects() const { return objects_; }

  KeyframeId add_keyframe(std::shared_ptr<const Frame> frame, const SE3& T_wc);
  /// Erases a keyframe and its observations; points that nobody else sees go with it. Planes
  /// that it saw, and what is relative to it, move to the keyframe that shares most points with it.
  void erase_keyframe(KeyframeId id);

  PointId add_point(const Eigen::Vector3d& position);
  void erase_point(PointId id);
  /// Both directions of the link. The keypoint must be free, the point not yet seen by the
  /// keyframe.
  void add_observation(PointId point, KeyframeId keyframe, std::uint32_t keypoint,
                       PatchState patch = PatchState::kUntried);
  /// Unlinks; a point that is left with fewer than two observations is erased.
  void erase_observation(PointId point, KeyframeId keyframe);
  /// `from` becomes `into`: observations move where the keyframe does not see `into` yet.
  void merge_points(PointId from, PointId into);

  /// From the keyframe that saw a point first to the point.
  double viewing_distance(PointId id) const;
  /// Measured points at these keypoints, in the keyframe's frame; those without a point are left
  /// out.
  std::vector<Eigen::Vector3d> measured_points_at(
      const Keyframe& keyframe, const std::vector<std::uint32_t>& keypoints) const;
  /// Does the keyframe see it by a corner (see Frame::corners)?
  bool is_corner(const Observation& o) const {
    return o.keypoint < keyframes_[o.keyframe].frame->corners();
  }
  /// From the keypoint that a keyframe has of a point to where it would see it at a position in the
  /// world, pixels; infinite where that is not before the camera.
  Eigen::Vector2d reprojection_error(KeyframeId keyframe, std::uint32_t keypoint,
                                     const Eigen::Vector3d& position) const;
  /// The keypoint by which a keyframe sees a point, or -1.
  int keypoint_of(PointId point, KeyframeId keyframe) const;
  /// Recomputes normal and base distance, or the descriptor, from the observations.
  void update_geometry(PointId id);
  void update_descriptor(PointId id);

  /// A new landmark with its first observation.
  PlaneId add_plane(KeyframeId keyframe, const SeenPlane& seen);
  /// The keyframe saw a plane of the map: one more observation, votes and outline.
  void observe_plane(PlaneId id, KeyframeId keyframe, const SeenPlane& seen);
  /// Points that are inside of the masks of a plane three times of five, at least.
  MaskedPoints points_in_masks(PlaneId id) const;
  /// Draws the outline anew from what all keyframes saw of the plane.
  void update_outline(PlaneId id);
  /// What each picture saw of a plane, those of keyframes that are gone among them.
  std::vector<PlaneOutlines> plane_views(PlaneId id) const;
  /// Points whose depth it gave go with it.
  void erase_plane(PlaneId id);
  /// Says that a point lies on a plane, or (invalid id) on none.
  void set_plane_of(PointId point, PlaneId plane);
  /// `from` becomes part of `into`.
  void merge_planes(PlaneId from, PlaneId into);
  /// In the world as it is now.
  Plane plane_in_world(PlaneId id) const;
  std::vector<Eigen::Vector3d> outline_in_world(PlaneId id) const;

  /// A new guess of an object with its first observation; `guess` is in the keyframe's frame.
  ObjectId add_object(KeyframeId keyframe, const SeenObject& seen, const Ellipsoid& guess);
  /// The keyframe saw an object of the map; of several boxes in one picture the first is kept.
  void observe_object(ObjectId id, KeyframeId keyframe, const SeenObject& seen);
  /// `from` becomes part of `into`, whose ellipsoid stays.
  void merge_objects(ObjectId from, ObjectId into);
  void erase_object(ObjectId id);
  /// In the world as it is now.
  Ellipsoid object_in_world(ObjectId id) const;
  /// The camera of an observation's picture to the world.
  SE3 camera_of(const ObjectObservation& o) const;
  void set_object_in_world(ObjectId id, const Ellipsoid& ellipsoid);

  /// Keyframes that share at least `min_shared` points with this one, those that share most first
  /// (then in order of making), and no more than `most`.
  std::vector<std::pair<KeyframeId, int>> covisible(
      KeyframeId id, int min_shared,
      std::size_t most = std::numeric_limits<std::size_t>::max()) const;
  /// Quantile (0.5: median) of the depths of the points that a keyframe sees; 0 where it sees none.
  double depth_quantile(KeyframeId id, double rank) const;
  /// How many points a keyframe's corners see: as many as a frame there can find. What corners
  /// missed is looked for in keyframes only.
  int tracked_points(KeyframeId id) const;
  /// Depths at the keypoints of a keyframe; where no point is, that of most.
  std::vector<double> depths(KeyframeId id) const;

  KeyframeId newest() const { return newest_; }
  KeyframeId first() const { return first_; }

 private:
  /// f(T_rk, outlines): of each picture of a plane its frame in that of the reference.
  template <class Function>
  void for_each_view(PlaneId id, Function&& f) const;

  void move_planes(KeyframeId from, KeyframeId to);
  void move_objects(KeyframeId from, KeyframeId to);

  View view_;
  LensCorrection lens_;
  double readout_ = 0, readout_estimate_ = 0;
  SlotMap<Keyframe, KeyframeId> keyframes_;
  SlotMap<MapPoint, PointId> points_;
  Covisibility covisibility_;
  SlotMap<PlaneLandmark, PlaneId> planes_;
  std::vector<RelatedPlanes> relations_;
  SlotMap<ObjectLandmark, ObjectId> objects_;
  std::uint32_t next_sequence_ = 0;
  KeyframeId first_, newest_;
};

}  // namespace cairn
