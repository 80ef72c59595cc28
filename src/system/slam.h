#pragma once

// The system room: the facade, the options, and the two schedules. It wires the stages together and
// owns their threads; it knows no files and no command line.

#include <cstddef>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/trajectory.h"
#include "cairn/map/frame_record.h"
#include "cairn/map/map_view.h"
#include "cairn/map/mapped_object.h"
#include "cairn/map/mapped_plane.h"
#include "cairn/mapping/metric_scale.h"
#include "cairn/perception/plane_detector.h"
#include "cairn/system/options.h"

namespace cairn {

/// What the facade says of one frame.
struct FrameResult {
  struct Feature {
    float x = 0, y = 0;   ///< pixels of the given picture
    bool mapped = false;  ///< an inlier that belongs to a map point
  };
  FrameRecord record;
  std::optional<SE3> T_wc;        ///< live pose, camera to world, where the frame was tracked
  std::vector<Feature> features;  ///< what was seen, for overlays
  /// What the plane detector saw in this very picture, with its masks, in the camera frame and the
  /// detector's metres: in lockstep of keyframes. In realtime it mostly says so when the picture is
  /// gone; then nothing is here. With Options::look_at_every_frame, of all frames in both.
  std::vector<DetectedPlane> planes;
  std::vector<DetectedObject> objects;  ///< likewise
};

/// Distances between keypoints and the projections of their map points, pixels of the full picture.
struct ReprojectionError {
  double median_px = 0, p75_px = 0, p95_px = 0;
  std::size_t observations = 0;
};

/// The map and what led to it, for people: see the members. Lengths are metres where the scale is
/// known, units of the map otherwise.
struct SlamResult {
  struct Point {
    Eigen::Vector3d position;                   ///< world frame = first keyframe
    Eigen::Matrix<unsigned char, 3, 1> colour;  ///< RGB
    int observations = 0;                       ///< keyframes that see it
  };
  struct Gap {
    double lost = 0;       ///< seconds: the first lost frame
    double recovered = 0;  ///< seconds; NaN if never
  };
  Trajectory trajectory;       ///< every tracked frame, carried by its keyframe into the final map
  Trajectory trajectory_live;  ///< the same, as known at the moment of tracking
  Trajectory keyframes;
  std::vector<Point> points;
  std::vector<MappedPlane> planes;
  std::vector<MappedObject> objects;
  std::map<std::string, int> object_refusals;  ///< how often one could not be born, by reason
  KeyframeTimes keyframe_times;
  ScaleEstimate scale;
  double readout = 0;  ///< of the shutter: seconds from a picture's first row to its last
  ReprojectionError reprojection;
  std::vector<Gap> gaps;  ///< losses and recoveries
  int restarts = 0;       ///< maps given up within their first seconds
  std::string refusal;    ///< why no map was initialised, empty if one was
};

/// Pictures of one moving camera in, trajectory and map out.
///
///     Slam slam(camera, options);
///     for (...) slam.process(picture, timestamp);
///     SlamResult result = slam.finish();
class Slam {
 public:
  /// With a detector, planes become part of the map, and the map gets metres.
  Slam(const Camera& camera, const Options& options,
       std::unique_ptr<PlaneDetector> planes = nullptr);
  ~Slam();

  /// `picture`: CV_8UC1 or CV_8UC3 (BGR), of the camera's size; timestamps in seconds, rising.
  /// `depth`: measured depth, CV_32F, metres, 0 where unknown; for detectors that use it.
  FrameResult process(const cv::Mat& picture, double timestamp, const cv::Mat& depth = {});
  /// Realtime: a frame that came too late to be processed; it is counted.
  void drop(double timestamp);
  /// A frame that cannot be used (broken picture, wrong size, time going back); it is counted.
  void skip(double timestamp);
  /// What `finish` is at.
  struct Finishing {
    enum class Stage { kLooking, kAdjusting } stage;
    std::size_t done, all;  ///< keyframes looked at; steps, of which fewer may be enough
  };
  using GoOn = std::function<bool(const Finishing&)>;
  /// Waits for the mapper, runs the full adjustment, and hands out everything. In realtime the
  /// detector may have been too slow for all keyframes: it looks at the others before that.
  /// `go_on`, if there is one, is asked before each of these, and after each step of the
  /// adjustment; false leaves the rest of either.
  SlamResult finish(const GoOn& go_on = {});

  /// The newest state of the local map, for viewers; immutable, so keep it as long as you like.
  /// Null while there is no map.
  std::shared_ptr<const MapView> snapshot() const;
  /// Rows of frames.csv so far.
  const std::vector<FrameRecord>& frames() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace cairn
