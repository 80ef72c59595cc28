#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/geometry/box.h"

namespace cairn {

/// What is drawn over one picture.
struct FrameOverlay {
  struct Feature {
    float x = 0, y = 0;   ///< pixels
    bool mapped = false;  ///< belongs to a map point
  };
  struct Mask {
    std::string label;
    cv::Mat inside;  ///< CV_8U, 255 inside, of the picture's size
  };
  struct Outline {
    std::string label;
    std::vector<cv::Point2f> corners;  ///< pixels, convex; see project_outline
  };
  std::vector<Mask> masks;        ///< of planes that are detected in this picture
  std::vector<Outline> outlines;  ///< of planes of the map
  std::vector<Outline> objects;   ///< of the map; see project_ellipsoid
  std::vector<Box2> boxes;        ///< of objects that are detected in this picture
  std::vector<Feature> features;
  std::string state;     ///< tracked, lost, ...
  int matches = 0;       ///< map points in this frame
  double fps = 0;        ///< 0: not shown
  double timestamp = 0;  ///< seconds
};

/// The picture (CV_8UC1 or CV_8UC3) in colour with the planes (in the colours of their labels;
/// masks are tinted), the features (green: of the map, grey: others), the objects (detections thin
/// and light, those of the map with their names), and a bar below with state, matches, frame rate
/// and time. CV_8UC3, higher by the bar; even sizes, as video codecs want.
cv::Mat draw_overlay(const cv::Mat& picture, const FrameOverlay& overlay);

/// Pictures of one size in rows of `columns`, each `width` pixels wide, as PNG or JPEG by the name.
/// Throws Error(kOutput).
void write_strip(const std::filesystem::path& file, const std::vector<cv::Mat>& pictures,
                 int columns, int width = 400);

}  // namespace cairn
