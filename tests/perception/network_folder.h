#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tiny_onnx.h"

namespace cairn::testing {

/// A folder for a test's cards and networks, removed with it.
class NetworkFolder {
 public:
  NetworkFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("cairn_networks_" + std::to_string(getpid()) + "_" + std::to_string(count()++))) {
    std::filesystem::create_directories(path_);
  }
  ~NetworkFolder() { std::filesystem::remove_all(path_); }
  NetworkFolder(const NetworkFolder&) = delete;
  NetworkFolder& operator=(const NetworkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Writes a file and says where it is.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  static int& count() {
    static int value = 0;
    return value;
  }
  std::filesystem::path path_;
};

/// The input of the tests' networks: 32 x 24, pixels as they are.
inline const std::string kTinyInput = "input: {width: 32, height: 24, channels: rgb}\n";

inline std::string depth_card(const std::string& more = "") {
  return "name: tiny\nkind: depth\nfile: tiny.onnx\noutput: depth\nunit: 0.01\n" + kTinyInput +
         more;
}

}  // namespace cairn::testing
