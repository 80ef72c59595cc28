#pragma once

// The perception room: what can be said of one picture without a map. Networks and the cards that
// describe them, plane detectors, recorded detections. It knows pictures, cameras and planes in the
// camera frame; it must know neither poses nor maps.

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/box.h"

namespace cairn {

/// What a detector says about one thing in a picture.
struct DetectedObject {
  Box2 box;
  std::string class_name;
  double score = 0;          ///< 0 to 1
  cv::Mat mask;              ///< CV_8U, 255 inside, of the picture's size; empty: not given
  std::optional<int> thing;  ///< which it is in truth; only a simulator knows
};

/// What a plane detector says about one surface.
struct DetectedPlane {
  Eigen::Vector4d plane = Eigen::Vector4d::Zero();  ///< camera frame, unit normal, metres
  std::string label;
  double score = 0;
  cv::Mat mask;               ///< CV_8U, 255 inside; in the pixels of the distorted picture
  std::optional<int> truth;   ///< which it is in truth, as an index into Scene::planes
  double sigma_angle = 0.05;  ///< of the normal about each axis across it, radians
  double sigma_depth = 0.05;  ///< of the offset, as a share of it
};

/// All that was detected in one picture.
struct DetectedFrame {
  double timestamp = 0;  ///< seconds
  std::vector<DetectedObject> objects;
  std::vector<DetectedPlane> planes;
  /// CV_32F, metres along the optical axis, of the picture's size or smaller, 0 where unknown;
  /// empty where the detector has none. Recorded coarsely.
  cv::Mat depth;
  /// Of the logarithm of the one scale that depth and planes share; 0 where it was measured.
  double sigma_scale = 0;
  std::string problem;  ///< why the picture could not be used; empty: it could. Not recorded
};

}  // namespace cairn
