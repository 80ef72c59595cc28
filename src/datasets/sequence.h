#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cairn/datasets/frame_source.h"
#include "cairn/geometry/camera.h"

namespace cairn {

struct OpenOptions {
  std::string layout = "auto";  ///< auto, tum, euroc, kitti, images, video, camera
  bool colour = true;           ///< false: pictures are handed out as CV_8UC1
  /// Frames a second of a folder of pictures without times; 0: as the calibration says, or 30.
  double fps = 0;
  std::optional<Camera> camera;       ///< in place of what the layout has
  std::filesystem::path calibration;  ///< a file in place of what the layout has
  std::string intrinsics;             ///< the text of --camera, in place of what the layout has
  bool depth = false;                 ///< read measured depth, too; TUM's layout has it
  bool prefetch = true;               ///< decode one frame ahead, in a thread (never if live)
};

/// Pictures and what is known about them.
struct Sequence {
  std::string layout;                                ///< tum, euroc, kitti, images, video, camera
  std::string name;                                  ///< short, fit for a folder name
  cv::Size size;                                     ///< of the pictures, pixels
  std::optional<Camera> camera;                      ///< of this size; none if nothing says it
  std::string calibration;                           ///< where the camera comes from, for people
  std::optional<std::filesystem::path> groundtruth;  ///< for read_groundtruth
  /// Other ground truths that are there (groundtruth_sfm.txt).
  std::vector<std::filesystem::path> more_groundtruth;
  double fps = 30;                      ///< frames a second
  std::unique_ptr<FrameSource> frames;  ///< frames without a `problem` have `size`, times rise
};

/// Opens a folder, a glob of pictures ("dir/*.png"), a video file or a camera ("camera:0").
/// Throws Error: kInput if it is not there, is of no known layout or has not one usable picture;
/// and if depth was asked for and is not there; kUsage if an option or calibration value cannot be
/// used.
Sequence open_sequence(const std::string& what, const OpenOptions& options = {});

}  // namespace cairn
