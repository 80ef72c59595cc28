#pragma once

// The mapping room: keyframes in, map out. It alone changes the map. It knows no threads and no
// pictures: the system room says when to map, the tracker what was seen.

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cairn/map/frame_record.h"
#include "cairn/map/initial_pair.h"
#include "cairn/map/map.h"
#include "cairn/map/map_view.h"
#include "cairn/mapping/buried_keyframe.h"
#include "cairn/mapping/keyframe_motion.h"
#include "cairn/mapping/metric_scale.h"
#include "cairn/mapping/object_mapping.h"
#include "cairn/mapping/plane_mapping.h"
#include "cairn/optimization/map_adjustment.h"

namespace cairn {

struct MappingOptions {
  int neighbours = 20;            ///< keyframes that new points are triangulated with
  double min_parallax_deg = 1.0;  ///< between the rays of a new point
  double match_ratio = 0.8;       ///< of a new point: nearest to second nearest descriptor
  int max_local_points = 4000;    ///< points in a published view
  double redundancy = 0.95;       ///< share of its points seen elsewhere that makes a keyframe go
  bool refine_lens = true;        ///< corrects at last what the calibration clearly got wrong
  double readout = 0;             ///< of the shutter, seconds; where it is estimated, a first guess
  AdjustmentOptions adjustment;
  PlaneMappingOptions planes;
  ObjectMappingOptions objects;
};

/// A frame that is to become a keyframe, as tracked.
struct KeyframeCandidate {
  std::shared_ptr<const Frame> frame;
  KeyframeId reference;  ///< T_wc = T_w,reference · T_rc
  SE3 T_rc;
  std::vector<PointId> points;                  ///< one a keypoint
  std::vector<char> aligned = {};               ///< as in TrackedFrame; empty: none is
  std::shared_ptr<const Picture> picture = {};  ///< if points are to be aligned in it
};

class Mapper {
 public:
  Mapper(const View& view, const MappingOptions& options);

  /// Starts the map: two keyframes, adjusted; median depth 1. False if too little is left of it.
  bool initialize(const InitialPair& initial);
  /// Takes a keyframe in: its points, new points, fusion; publishes. `adjust` does the rest.
  KeyframeId insert(const KeyframeCandidate& candidate);
  /// What perception says of a keyframe, which may be culled by now: then nothing happens.
  /// Publishes.
  void join(const KeyframePerception& seen);
  /// The keyframe that a picture became; invalid where it is none, or has been culled.
  KeyframeId keyframe_of(const Frame& frame) const;
  /// Local adjustment and culling after an insertion; publishes. Does nothing where the last was a
  /// moment ago, unless the map is young. May be told to stop early.
  void adjust(const StopAsked& stop);
  /// The end: fusion over the whole map, then full adjustment. `motions`: of keyframes, as all
  /// frames show them.
  AdjustmentSummary finish(const StopAsked& stop, std::span<const KeyframeMotion> motions = {});
  /// How often `finish` asks whether it should stop, at most.
  std::size_t most_steps() const;

  /// What the tracker saw and should have seen, for culling.
  void count_visible(std::span<const PointId> visible, std::span<const PointId> found);

  /// A lost camera was found by this keyframe: until the next insertion the view is around it.
  /// Publishes.
  void look_around(KeyframeId keyframe);
  /// The newest snapshot.
  const std::shared_ptr<const MapView>& view() const { return view_; }
  const Map& map() const { return map_; }
  ScaleEstimate scale() const;
  /// How often an object could not be born, by reason.
  const std::map<std::string, int>& object_refusals() const { return object_refusals_; }
  const KeyframeTimes& times() const { return times_; }
  /// Keyframes that may show the same place: the `count` most alike, best first.
  std::vector<KeyframeId> similar_keyframes(const Features& features, int count) const;
  const std::vector<BuriedKeyframe>& buried() const { return buried_; }

 private:
  void measure(PointId id);
  void join_planes(KeyframeId keyframe, const KeyframePerception& seen);
  void join_objects(KeyframeId keyframe, const KeyframePerception& seen);
  void measure_scale_anew();
  void publish();
  void cull_recent_points();
  void cull_keyframes();

  MappingOptions options_;
  Map map_;
  MetricScale scale_;
  std::map<std::string, int> object_refusals_;
  KeyframeTimes times_;
  std::vector<PointId> recent_;  // points on probation
  std::vector<BuriedKeyframe> buried_;
  KeyframeId standpoint_;     // where the camera is: the view is around it
  double last_adjusted_ = 0;  // seconds, of the keyframe
  int adjustments_ = 0;
  std::uint64_t version_ = 0;
  std::shared_ptr<const MapView> view_;
};

}  // namespace cairn
