#pragma once

#include <filesystem>
#include <string>

#include "cairn/synthetic/world.h"

namespace cairn::app {

enum class SynthSensor { kMono, kStereo, kRgbd };

/// Writes a rendered sequence: TUM's layout, or KITTI's for a stereo rig, with the truth beside it.
/// What makes the folder a sequence comes last (finish), so that nothing looks complete before it
/// is. Throws Error(kOutput) that names the file.
class SequenceFolder {
 public:
  /// `folder` exists. Removes the lists of an earlier sequence in it.
  SequenceFolder(std::filesystem::path folder, SynthSensor sensor, const Camera& camera, double fps,
                 double baseline);

  /// The next frame. `right`: of a stereo rig. `depth` (CV_32F, metres): of an RGB-D camera.
  void add(const SE3& T_wc, const cv::Mat& picture, const cv::Mat& right, const cv::Mat& depth);
  /// Truth about the frame that was added last: a line of truth.jsonl and pictures.
  void add_truth(const FrameTruth& truth, const Scene& scene);
  /// What was detected in the frame that was added last: a line of perception.jsonl.
  void add_detections(const std::string& line) { detections_ += line + "\n"; }
  /// Poses, calibration, lists, and `world_json`.
  void finish(const std::string& world_json);

  /// Seconds of frame i: as a clock would give them, but for KITTI's, which begin with zero.
  double timestamp(int frame) const;

 private:
  void finish_tum();
  void finish_kitti();
  std::string frame_name(int frame) const;

  std::filesystem::path folder_, pictures_;
  SynthSensor sensor_;
  Camera camera_;
  double fps_, baseline_;
  int frames_ = 0;
  bool with_truth_ = false;
  std::string list_, depth_list_, poses_, kitti_poses_, times_, truth_, detections_;
  SE3 first_;
};

}  // namespace cairn::app
