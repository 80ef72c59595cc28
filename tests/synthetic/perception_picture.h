#pragma once

#include <string>
#include <vector>

#include "cairn/synthetic/perception_simulator.h"

namespace cairn::testing {

inline const Camera kPerceptionCamera(Camera::Model::kRadialTangential, 640, 480,
                                      {500, 500, 319.5, 239.5});

/// A picture of things that are rectangles, before a wall that fills the picture two metres away.
class PerceptionPicture {
 public:
  PerceptionPicture() {
    truth_.depth = cv::Mat(480, 640, CV_32F, cv::Scalar(2));
    truth_.normals = cv::Mat(480, 640, CV_32FC3, cv::Scalar(0, 0, -1));
    truth_.labels = cv::Mat(480, 640, CV_8U, cv::Scalar(0));
    truth_.instances = cv::Mat(480, 640, CV_16U, cv::Scalar(0));
    truth_.planes = cv::Mat(480, 640, CV_16U, cv::Scalar(1));
    scene_.planes.push_back({"wall", {0, 0, -1}, 2, {}});
    truth_.visible_planes.push_back({0, {0, 0, -1, 2}, 480 * 640});
  }

  /// One that covers these pixels; cut if it reaches the border of the picture.
  PerceptionPicture& add(const std::string& class_name, const cv::Rect& pixels,
                         double visible = 1) {
    const int index = int(scene_.things.size());
    scene_.things.emplace_back();
    scene_.things.back().model.class_name = class_name;
    scene_.things.back().is_object = true;
    truth_.instances(pixels) = index + 1;
    const Box2 box = {pixels.x - 0.5, pixels.y - 0.5, pixels.br().x - 0.5, pixels.br().y - 0.5};
    const bool cut = pixels.x == 0 || pixels.y == 0 || pixels.br().x == 640 || pixels.br().y == 480;
    truth_.objects.push_back({index, pixels.area(), box, box, visible, cut});
    return *this;
  }

  const FrameTruth& truth() const { return truth_; }
  FrameTruth& truth() { return truth_; }
  const Scene& scene() const { return scene_; }
  PerceptionSimulator simulator(const PerceptionNoise& noise, std::uint64_t seed = 1) const {
    return PerceptionSimulator(scene_, kPerceptionCamera, noise, seed);
  }

 private:
  FrameTruth truth_;
  Scene scene_;
};

}  // namespace cairn::testing
