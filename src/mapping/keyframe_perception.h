#pragma once

#include <memory>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/map/map.h"
#include "cairn/perception/detections.h"

namespace cairn {

/// What perception says of a keyframe's picture, reduced to its keypoints: no picture is kept.
/// Lengths are the detector's metres.
struct KeyframePerception {
  std::shared_ptr<const Frame> frame;  ///< which the keyframe holds
  double sigma_scale = 0;              ///< of the logarithm of the scale of all lengths
  std::vector<float> depth;            ///< predicted, one a keypoint; 0: unknown
  double mean_depth = 0;               ///< of the whole picture, geometric; 0: unknown
  std::vector<SeenPlane> planes;
};

/// `camera`: with the lens, as the picture was taken. Where a detector gives no depth, that of the
/// planes serves. Planes that cannot be (not finite, not in front of the camera, no mask) are left
/// out.
KeyframePerception summarize_perception(const DetectedFrame& detected,
                                        std::shared_ptr<const Frame> frame, const Camera& camera,
                                        const View& view);

/// How the unit of a picture's predicted depth compares with the map's.
struct PictureScale {
  bool usable = false;
  double scale = 1;      ///< map units a metre of the detector
  double log_error = 0;  ///< spread of the logarithm over the points: local errors of the depth
  int points = 0;
  // What tells of the contrast, from the points that agree; logarithms of depths, the predicted
  // ones as they came, from the picture's mean.
  double contrast = 1;    ///< that was taken for the scale
  double predicted = 0;   ///< mean over the points
  double variance = 0;    ///< of depth in the map
  double covariance = 0;  ///< of the two
};

/// One robust scale from the keyframe's map points: the median of their depth over the predicted
/// one, stretched by `contrast` (see stretched_depth).
PictureScale align_picture(const Map& map, KeyframeId keyframe, const KeyframePerception& seen,
                           double contrast = 1);

}  // namespace cairn
