#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "cairn/perception/network.h"

namespace cairn {

/// What networks say of all parts of a picture, on one grid that covers it (as in cv::resize).
struct SceneMaps {
  cv::Mat_<float> depth;  ///< metres along the optical axis, > 0, 0 where unknown; may be empty
  cv::Mat_<cv::Vec3f> normals;  ///< camera frame, unit, towards the camera, 0 unknown; may be empty
  cv::Mat_<uchar> labels;       ///< index into SceneNetwork::planar_labels(); may be empty
  std::string problem;          ///< why all are empty
  double sigma_scale = 0;       ///< of the logarithm of the true scale of the depth; 0 without
};

/// Depth, normals and labels of pictures, each from a network of its own.
class SceneNetwork {
 public:
  /// At most one card of a kind; not kPlanes or kObjects. Throws Error as Network does, kUsage for
  /// such cards.
  explicit SceneNetwork(const std::vector<NetworkCard>& cards);

  /// Maps of the size `grid`. A failing network leaves all maps empty, with a problem.
  SceneMaps look(const cv::Mat& bgr, const cv::Size& grid);

  bool gives(NetworkCard::Kind kind) const { return find(kind) != nullptr; }
  /// By index in SceneMaps::labels: the names of those whose regions may be planes, "" for others;
  /// empty without a network of labels.
  const std::vector<std::string>& planar_labels() const { return planar_labels_; }

 private:
  enum class Place { kAnywhere, kIndoors, kOutdoors };  // where there is what a label names

  bool outdoors(const cv::Mat_<uchar>& labels) const;
  Network* find(NetworkCard::Kind kind) const;

  std::vector<std::unique_ptr<Network>> networks_;
  std::vector<std::string> planar_labels_;
  std::vector<Place> places_;  // by index in SceneMaps::labels
};

}  // namespace cairn
