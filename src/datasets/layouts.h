#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cairn/datasets/calibration.h"
#include "cairn/datasets/picture_list_source.h"

namespace cairn {

/// What a layout on disk promises: pictures, where their camera is described, the ground truth.
struct Listing {
  std::string name;
  std::vector<ListedPicture> pictures;
  std::string list;  ///< where the pictures are listed, for sentences
  /// Reads the calibration of the layout for pictures of the given size; empty if it has none.
  std::function<Calibration(const cv::Size&)> calibration;
  std::string calibration_name;
  /// Reads how depth is measured; empty where nothing says it.
  std::function<DepthCalibration(const cv::Size&)> depth;
  std::optional<std::filesystem::path> groundtruth;
  std::vector<std::filesystem::path> more_groundtruth;
};

bool is_tum(const std::filesystem::path& folder);
bool is_euroc(const std::filesystem::path& folder);
bool is_kitti(const std::filesystem::path& folder);

/// Each throws Error(kInput) if what makes the layout is missing.
Listing list_tum(const std::filesystem::path& folder);
Listing list_euroc(const std::filesystem::path& folder);
Listing list_kitti(const std::filesystem::path& folder);
/// The depth pictures of TUM's layout. Throws Error(kInput) if it has none.
std::vector<ListedPicture> list_tum_depth(const std::filesystem::path& folder);
/// A folder, or a glob whose last part has * or ?. `fps`: for names that are no times; 0: default.
Listing list_images(const std::filesystem::path& folder_or_glob, double fps);

/// Takes a calibration file, found in one of the folders under one of the usual names, into the
/// listing.
void find_calibration(const std::vector<std::filesystem::path>& folders, Listing& listing);
/// The same for groundtruth.txt and groundtruth_sfm.txt.
void find_groundtruth(const std::vector<std::filesystem::path>& folders, Listing& listing);

/// Compares texts with the numbers in them by value: frame2 before frame10.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace cairn
