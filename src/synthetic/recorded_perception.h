#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cairn/synthetic/frame_truth.h"

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
  cv::Mat mask;              ///< CV_8U, 255 inside
  std::optional<int> truth;  ///< which it is in truth, as an index into Scene::planes
};

/// All that was detected in one picture.
struct DetectedFrame {
  double timestamp = 0;  ///< seconds
  std::vector<DetectedObject> objects;
  std::vector<DetectedPlane> planes;
};

/// A line of perception.jsonl, without the line's end: {"timestamp": s, "objects": [{"box":
/// [x0,y0,x1,y1], "class": "cup", "score": 0.91, "mask": RLE?, "thing": id?}], "planes": [{"plane":
/// [a,b,c,d], "label": "table", "score": 0.8, "mask": RLE?, "truth": id?}]}. RLE as COCO's
/// (mask_rle.h). Boxes have three decimals, scores five.
std::string to_json_line(const DetectedFrame& frame);

/// Reads such a line. Throws Error(kInput) with a sentence that begins with `where` ("file, line
/// 3") if it is not in the format, or has numbers that are not finite, scores outside of 0 to 1,
/// boxes without area, planes without a normal. Keys that it does not know are passed over.
DetectedFrame parse_json_line(const std::string& line, const std::string& where);

/// All lines of a file, in their order; empty lines are passed over. Throws Error(kInput).
std::vector<DetectedFrame> read_recorded_perception(const std::filesystem::path& file);

}  // namespace cairn
