#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/perception/detections.h"
#include "cairn/synthetic/frame_truth.h"
#include "cairn/synthetic/hashed_noise.h"
#include "cairn/synthetic/perception_noise.h"
#include "cairn/synthetic/scene.h"

namespace cairn {

/// Says of a picture whose truth is known what networks would say: the truth with their errors.
/// Errors of one thing at one time follow from the seed alone, so pictures may come in any order
/// and from any thread. Time is counted in thirtieths of a second.
class PerceptionSimulator {
 public:
  /// Takes from the scene what its things and planes are called. `camera`: of all pictures.
  PerceptionSimulator(const Scene& scene, const Camera& camera, const PerceptionNoise& noise,
                      std::uint64_t seed);

  /// Objects by falling score, planes by index. With masks, if these are wanted.
  DetectedFrame detect(const FrameTruth& truth, double timestamp, bool masks = true) const;
  /// CV_32F, metres along the optical axis, 0 where nothing is.
  cv::Mat depth(const FrameTruth& truth, double timestamp) const;
  /// CV_32FC3, camera frame, 0 where nothing is.
  cv::Mat normals(const FrameTruth& truth, double timestamp) const;

 private:
  struct Picture;  // what all detections of a picture share

  void detect_object(const Picture& picture, const ObjectView& view,
                     std::vector<DetectedObject>& found) const;
  double confidence(const Picture& picture, const ObjectView& view, const Box2& box) const;
  Box2 noisy_box(const Picture& picture, const ObjectView& view, double z) const;
  std::string noisy_class(const Picture& picture, int thing) const;
  const std::vector<std::string>* family_of(const std::string& class_name) const;
  void add_duplicate(const Picture& picture, const DetectedObject& object,
                     std::vector<DetectedObject>& found) const;
  void add_false_alarms(const Picture& picture, std::vector<DetectedObject>& found) const;
  void add_false_alarm(const HashedNoise& alarm, const Picture& picture,
                       std::vector<DetectedObject>& found) const;
  Eigen::Vector4d noisy_plane(const PlaneView& view, const cv::Mat& mask, double time) const;
  void detect_plane(const Picture& picture, const PlaneView& view,
                    std::vector<DetectedPlane>& found) const;

  std::vector<std::string> classes_;       // of Scene::things
  std::vector<std::string> plane_labels_;  // of Scene::planes
  Camera camera_;
  PerceptionNoise noise_;
  HashedNoise source_;
};

}  // namespace cairn
