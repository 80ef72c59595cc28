#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "cairn/geometry/box.h"

namespace cairn {

/// An object in a picture.
struct ObjectView {
  int thing = 0;           ///< index into Scene::things
  int pixels = 0;          ///< that show it
  Box2 visible_box;        ///< around these
  Box2 amodal_box;         ///< of all of it, hidden or not, also beyond the border of the picture
  double visible = 0;      ///< share of its outline that is seen, 0 to 1
  bool truncated = false;  ///< the border of the picture cuts it
};

/// A plane in a picture.
struct PlaneView {
  int plane = 0;                                         ///< index into Scene::planes
  Eigen::Vector4d parameters = Eigen::Vector4d::Zero();  ///< camera frame, unit normal, metres
  int pixels = 0;                                        ///< that show it
};

/// The truth about one picture; all pictures are of its size.
struct FrameTruth {
  cv::Mat depth;      ///< CV_32F, metres along the optical axis; 0: nothing
  cv::Mat normals;    ///< CV_32FC3, camera frame, unit, towards the camera; 0: nothing
  cv::Mat labels;     ///< CV_8U, index into World::labels()
  cv::Mat instances;  ///< CV_16U, index into Scene::things plus one; 0: nothing
  cv::Mat planes;     ///< CV_16U, index into Scene::planes plus one; 0: none
  std::vector<ObjectView> objects;        ///< those that are seen, by index
  std::vector<PlaneView> visible_planes;  ///< by index
};

}  // namespace cairn
