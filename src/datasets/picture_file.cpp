#include "cairn/datasets/picture_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

namespace cairn {
namespace {

using Bytes = std::span<const unsigned char>;

bool read_bytes(const std::filesystem::path& file, std::vector<unsigned char>& bytes) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return false;
  bytes.resize(std::size_t(std::max<std::streamoff>(0, stream.tellg())));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  return bool(stream);
}

// Walks the segments to the end marker FF D9. Looking at the last two bytes alone would refuse
// pictures with a trailer (phones add one) and accept a cut inside of an embedded thumbnail.
bool is_complete_jpeg(Bytes bytes) {
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xFF) {  // inside of a scan, or junk between segments: to the next marker
      const void* next = std::memchr(&bytes[at], 0xFF, bytes.size() - at);
      if (next == nullptr) return false;
      at = std::size_t(static_cast<const unsigned char*>(next) - bytes.data());
      continue;
    }
    const unsigned char marker = bytes[at + 1];
    if (marker == 0xD9) return true;
    const bool alone = marker == 0 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    if (marker == 0xFF) {
      at += 1;  // padding
    } else if (alone) {
      at += 2;
    } else {
      if (at + 3 >= bytes.size()) return false;
      at += 2 + (std::size_t(bytes[at + 2]) << 8 | bytes[at + 3]);
    }
  }
  return false;
}

bool is_complete_png(Bytes bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = std::size_t(bytes[at]) << 24 | std::size_t(bytes[at + 1]) << 16 |
                               std::size_t(bytes[at + 2]) << 8 | bytes[at + 3];
    if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return true;
    at += 12 + length;
  }
  return false;
}

bool ends_in(const std::filesystem::path& file, std::span<const std::string_view> endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

// Picture files of any kind; `flags` of cv::imdecode.
cv::Mat decode(const std::filesystem::path& file, int flags, std::string& problem) {
  problem.clear();
  std::error_code code;
  std::vector<unsigned char> bytes;
  if (!std::filesystem::exists(file, code)) {
    problem = file.string() + ": the file is missing";
  } else if (std::filesystem::is_directory(file, code)) {
    problem = file.string() + ": this is a folder, not a picture";
  } else if (!read_bytes(file, bytes)) {
    problem = file.string() + ": the file cannot be read; check its permissions";
  } else if (bytes.empty()) {
    problem = file.string() + ": the file is empty";
  } else if (!is_complete_picture(bytes)) {
    problem = file.string() + ": the picture is cut off before its end; copy the file again";
  }
  if (!problem.empty()) return {};
  cv::Mat picture;
  try {
    picture = cv::imdecode(bytes, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) problem = file.string() + ": this is not a picture that can be decoded";
  return picture;
}

}  // namespace

bool is_complete_picture(Bytes bytes) {
  constexpr std::array<unsigned char, 4> kPng = {0x89, 'P', 'N', 'G'};
  if (bytes.size() >= 2 && bytes[0] == 0xFF && bytes[1] == 0xD8) return is_complete_jpeg(bytes);
  if (bytes.size() >= 4 && std::equal(kPng.begin(), kPng.end(), bytes.begin())) {
    return is_complete_png(bytes);
  }
  return true;
}

cv::Mat read_picture(const std::filesystem::path& file, bool colour, std::string& problem) {
  return decode(file, colour ? cv::IMREAD_ANYCOLOR : cv::IMREAD_GRAYSCALE, problem);
}

cv::Mat read_depth_picture(const std::filesystem::path& file, std::string& problem) {
  cv::Mat picture = decode(file, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR, problem);
  if (problem.empty() && picture.type() != CV_16UC1) {
    problem = file.string() + ": this is no depth picture, which is grey with 16 bits";
  }
  return problem.empty() ? picture : cv::Mat();
}

std::string in_pixels(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

bool is_picture_name(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 9> kEndings = {".png",  ".jpg",  ".jpeg", ".bmp", ".tif",
                                                        ".tiff", ".webp", ".pgm",  ".ppm"};
  return ends_in(file, kEndings);
}

bool is_video_name(const std::filesystem::path& file) {
  constexpr std::array<std::string_view, 9> kEndings = {".mp4", ".avi", ".mov",  ".mkv", ".webm",
                                                        ".m4v", ".mpg", ".mpeg", ".mjpg"};
  return ends_in(file, kEndings);
}

}  // namespace cairn
