#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// How depth was measured.
struct DepthCalibration {
  /// Of a depth camera that is not the colour camera; none: depth is in the pixels of the colour.
  std::optional<Camera> camera{};
  SE3 T_color_depth{};  ///< depth camera to colour camera, metres
  double scale = 5000;  ///< steps of a depth picture a metre
};

/// What a calibration file says.
struct Calibration {
  Camera camera;
  std::optional<double> fps;  ///< frames a second
  std::optional<SE3> T_bs;    ///< camera to body (EuRoC's T_BS)
};

/// Reads a calibration file; its form is recognised:
/// - cairn's own calibration.yaml (`color:` with fx, fy, cx, cy, width, height, distortion),
/// - the same keys at the top, also with a prefix `Camera.`, or `intrinsics: [fx, fy, cx, cy]`,
/// - EuRoC sensor.yaml and Kalibr camchain (`cam0:`), radtan and equidistant,
/// - ROS camera_info (`camera_matrix: data`, `distortion_coefficients: data`),
/// - KITTI calib.txt (the row `P0:`).
/// `size` is used where the file gives none. Throws Error: kInput if the file cannot be read,
/// kUsage if a value in it cannot be used.
Calibration read_calibration_file(const std::filesystem::path& file,
                                  std::optional<cv::Size> size = std::nullopt);

/// Of the section `depth:` of cairn's own calibration.yaml; the default where there is none. Keys:
/// `scale` (steps a metre); where depth has a camera of its own, the keys of `color:`, too, and
/// `T_color_depth` (4x4, row by row, depth camera to colour camera, metres; without it the two are
/// in one place). Throws as
/// read_calibration_file.
DepthCalibration read_depth_calibration(const std::filesystem::path& file,
                                        std::optional<cv::Size> size = std::nullopt);

/// The camera of read_calibration_file.
Camera read_calibration(const std::filesystem::path& file,
                        std::optional<cv::Size> size = std::nullopt);

/// The row `row` ("P0" to "P3") of a KITTI calib.txt.
Camera read_kitti_calibration(const std::filesystem::path& file, const std::string& row,
                              const cv::Size& size);

/// "fx,fy,cx,cy[,k1,k2,p1,p2[,k3]]" in pixels of a picture of the given size. Throws Error(kUsage).
Camera parse_camera(const std::string& values, int width, int height);

}  // namespace cairn
