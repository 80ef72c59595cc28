#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>

namespace cairn {

/// Reads a picture as it is stored: CV_8UC1 if it is grey or if `colour` is false, else CV_8UC3
/// (BGR). Orientation tags are ignored, because calibrations are of the sensor. Where it cannot be
/// read, `problem` says why in a sentence and the picture is empty.
cv::Mat read_picture(const std::filesystem::path& file, bool colour, std::string& problem);

/// Reads a depth picture as it is stored: CV_16UC1. Else as read_picture.
cv::Mat read_depth_picture(const std::filesystem::path& file, std::string& problem);

/// Whether a JPEG or PNG file is there to its end marker. Decoders fill what is missing of a cut
/// JPEG with grey and say nothing. Files of other kinds pass.
bool is_complete_picture(std::span<const unsigned char> bytes);

/// "640x480", for sentences.
std::string in_pixels(const cv::Size& size);

/// By the ending of its name.
bool is_picture_name(const std::filesystem::path& file);
bool is_video_name(const std::filesystem::path& file);

}  // namespace cairn
