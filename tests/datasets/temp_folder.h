#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "cairn/geometry/error.h"

namespace cairn {

/// A folder of one test, removed at its end.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cairn_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// A picture with something in it, different for each number.
inline cv::Mat test_picture(int number, cv::Size size = {64, 48}) {
  cv::Mat picture(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      picture.at<cv::Vec3b>(y, x) = {uchar(4 * x), uchar(5 * y), uchar(10 * number)};
    }
  }
  return picture;
}

inline std::filesystem::path write_picture(const std::filesystem::path& file, int number,
                                           cv::Size size = {64, 48}) {
  std::filesystem::create_directories(file.parent_path());
  cv::imwrite(file.string(), test_picture(number, size));
  return file;
}

/// The sentence of the error that `action` throws, after checking its kind.
template <typename Action>
std::string error_of(Error::Kind kind, Action&& action) {
  try {
    action();
  } catch (const Error& e) {
    EXPECT_EQ(int(e.kind()), int(kind)) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

}  // namespace cairn
