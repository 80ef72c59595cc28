#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cairn/association/plane_association.h"
#include "cairn/map/frame_record.h"
#include "cairn/map/map_view.h"
#include "cairn/optimization/pose_adjustment.h"
#include "cairn/tracking/projection_search.h"

namespace cairn {

struct TrackingOptions {
  double sigma_px = 1.0;  ///< of the position of a keypoint of octave 0
  int min_inliers = 30;   ///< points that must agree with a pose
  int min_prediction_inliers =
      12;                         ///< points of the last frame that must agree with the prediction
  bool align = true;              ///< keypoints to where the picture looks as their points did
  double search_radius = 15;      ///< pixels around the prediction of the motion model
  int max_local_points = 4000;    ///< points of the map that a frame is compared with
  int few_points = 60;            ///< with fewer inliers planes help to hold the camera
  int min_supported_inliers = 6;  ///< points that must agree with a pose that planes hold
  bool relocalize_by_objects = true;  ///< where points do not find a lost camera
};

/// What the tracker found out about one frame.
struct TrackedFrame {
  std::shared_ptr<const Frame> frame;
  SE3 T_wc;
  KeyframeId reference;          ///< keyframe that carries the frame
  SE3 T_rc;                      ///< camera to reference keyframe
  std::uint32_t last_birth = 0;  ///< sequence number of the newest keyframe of the map then
  std::vector<PointId> points;   ///< one a keypoint: inliers
  std::vector<char> aligned;     ///< one a keypoint: lies where it looks as its point did
  std::vector<PointId> visible;  ///< points that should have been seen
  int matches = 0, inliers = 0;
};

/// The planes of the present picture, in metres of their detector, asked for where points are few.
using PlanesInSight = std::function<std::vector<SeenPlane>()>;

/// Follows the camera from frame to frame. Single-threaded; holds no map, only the last frame.
class Tracker {
 public:
  Tracker(const View& view, const TrackingOptions& options);

  /// The pose of a frame, or nothing if the map was lost. `view` is the newest there is. Moves the
  /// frame's keypoints to where `picture`, if it is given, looks as their points did, and to where
  /// a shutter would have seen them that does not roll. Fills the stage times of `record`.
  const TrackedFrame* track(std::shared_ptr<Frame> frame,
                            const std::shared_ptr<const MapView>& view, FrameRecord& record,
                            const PlanesInSight& planes_in_sight = {},
                            const Picture* picture = nullptr);

  /// Tracking goes on from a frame whose pose is known (initialisation, relocalisation).
  void start_from(std::shared_ptr<const Frame> frame, const SE3& T_wc,
                  const std::shared_ptr<const MapView>& view, const std::vector<PointId>& points);

  /// Is the frame that was tracked last worth a keyframe, that `before_it` others go before?
  bool wants_keyframe(int before_it) const;

  const TrackedFrame& last() const { return last_; }

 private:
  void adopt_view(const std::shared_ptr<const MapView>& view);
  SE3 predict(double timestamp) const;
  double step_to(double timestamp) const;
  Vector6d velocity_at(double timestamp, const SE3& T_wc) const;
  void unroll(Frame& frame, const SE3& T_wc);
  void unroll_observations(const Frame& frame, const SE3& T_wc);
  bool track_motion(const Frame& frame, SE3& T_wc);
  bool track_reference(const Frame& frame, SE3& T_wc);
  bool track_local_map(Frame& frame, const Picture* picture, SE3& T_wc);
  bool track_supported(Frame& frame, const Picture* picture, SE3& T_wc,
                       const std::vector<SeenPlane>& planes);
  void align(Frame& frame, const Picture& picture, const SE3& T_cw);
  PoseSupport support(const SE3& T_wc, double timestamp,
                      const std::vector<SeenPlane>& planes) const;
  PosePrior expected_motion(const SE3& T_wc, double timestamp) const;
  bool sees_planes() const { return support_ && !support_->planes.empty(); }
  int adjust(const Frame& frame, SE3& T_wc, bool unroll = false);

  View view_;
  TrackingOptions options_;
  std::shared_ptr<const MapView> map_;
  TrackedFrame last_;
  std::vector<std::uint32_t> last_points_;  // a keypoint of the last frame: index into map_->points
  SE3 velocity_;                            // motion of the camera in one frame, in its own frame
  double velocity_seconds_ = 0;
  bool has_velocity_ = false;
  int frames_since_start_ = 0;
  std::optional<PoseSupport> support_;  // of the present frame: planes where it needs some

  // Reused between frames.
  std::vector<std::uint32_t> current_points_;
  std::vector<ExpectedPoint> expected_;
  std::vector<PoseObservation> observations_;
  std::vector<std::uint32_t> observed_keypoints_;
  std::vector<char> inlier_;
  std::vector<char> seen_;
  std::vector<char> aligned_;
  std::vector<double> depths_;
};

}  // namespace cairn
