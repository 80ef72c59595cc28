#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cairn/map/map.h"

namespace cairn {

/// An immutable snapshot of the part of the map around one keyframe: all that the tracker needs.
/// The mapper publishes one after each change; readers keep theirs as long as they like.
struct MapView {
  struct Point {
    PointId id;
    Eigen::Vector3d position;  ///< world
    Eigen::Vector3f normal;    ///< mean viewing direction, unit
    float base_distance = 0;   ///< distance at which it would show in octave 0
    Descriptor descriptor;
    std::shared_ptr<const PointPatch> patch;  ///< what it looked like; none where nobody knows
  };
  struct KeyframePose {
    KeyframeId id;
    SE3 T_wc;
  };

  struct PlanePose {
    PlaneId id;
    Plane plane;  ///< world
    std::string label;
    std::vector<Eigen::Vector3d> outline;  ///< world
    double sigma_tilt = 0;                 ///< of its normal, radians
    bool confirmed = false;
  };

  struct ObjectPose {
    ObjectId id;
    Ellipsoid ellipsoid;  ///< world
    std::string class_name;
  };

  std::uint64_t version = 0;
  KeyframeId reference;  ///< the keyframe it was made around
  std::shared_ptr<const Frame> reference_frame;
  std::vector<std::uint32_t> reference_points;    ///< a keypoint: index into points, or kNone
  int reference_tracked = 0;                      ///< points that its corners see
  double median_depth = 0;                        ///< of the points that the reference sees
  std::uint32_t newest = 0;                       ///< sequence number of the newest keyframe
  std::size_t map_keyframes = 0, map_points = 0;  ///< of the whole map
  std::vector<Point> points;                      ///< in order of ids
  std::vector<KeyframePose> keyframes;            ///< local ones, in order of ids
  std::vector<PlanePose> planes;                  ///< of the whole map, in order of ids
  std::vector<ObjectPose> objects;                ///< those that are born, in order of ids
  double readout = 0;                             ///< of the shutter, seconds (Map::readout)
  double units_a_metre = 0;                       ///< of the plane detector; 0: unknown

  static constexpr std::uint32_t kNone = 0xffffffffU;

  /// Index into `points`, or kNone.
  std::uint32_t index_of(PointId id) const;
  std::optional<SE3> pose_of(KeyframeId id) const;
};

/// The view around a keyframe: its points, those of the keyframes that share points with it, and of
/// their best neighbours; the closest keyframes first, until `max_points` are there.
std::shared_ptr<const MapView> make_view(const Map& map, KeyframeId reference, int max_points,
                                         std::uint64_t version);

}  // namespace cairn
