// A folder of pictures, or a glob of them.
#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <compare>

#include "cairn/datasets/layouts.h"
#include "cairn/datasets/picture_file.h"
#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

bool is_glob(const fs::path& path) {
  return path.filename().string().find_first_of("*?[") != std::string::npos;
}

std::vector<fs::path> picture_files(const fs::path& folder, const std::string& pattern) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) {
    throw Error(Error::Kind::kInput,
                folder.string() + ": there is no such folder; check the path of the pictures");
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    const bool fits = pattern.empty() ? is_picture_name(entry.path())
                                      : fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
    if (fits && name[0] != '.' && !entry.is_directory()) files.push_back(entry.path());
  }
  if (code) {
    throw Error(Error::Kind::kInput, folder.string() + ": the folder cannot be read (" +
                                         code.message() + "); check its permissions");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

// What the names of all files say: seconds ("12.5.png"), Unix time in whole milli-, micro- or
// nanoseconds (13, 16, 19 digits), the number of the frame (less digits), or nothing.
std::vector<double> times_of(const std::vector<fs::path>& files, double fps) {
  std::vector<double> times(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) times[i] = double(i) / fps;
  const auto from_names = [&](auto&& time_of) {
    std::vector<double> named;
    for (const fs::path& file : files) {
      const std::optional<double> time = time_of(file.stem().string());
      if (!time) return false;
      named.push_back(*time);
    }
    times = named;
    return true;
  };
  const auto whole = [&](std::size_t digits_from, std::size_t digits_to, double unit) {
    return from_names([&](const std::string& stem) -> std::optional<double> {
      const auto number = parse_integer(stem);
      const std::size_t digits = stem.size() - (stem[0] == '-');
      if (!number || digits < digits_from || digits > digits_to) return std::nullopt;
      return double(*number) * unit;
    });
  };
  if (whole(18, 19, 1e-9) || whole(15, 17, 1e-6) || whole(12, 14, 1e-3) || whole(1, 9, 1 / fps)) {
    return times;
  }
  from_names([](const std::string& stem) -> std::optional<double> {
    if (stem.find('.') == std::string::npos && stem.size() != 10) return std::nullopt;
    return parse_number(stem);
  });
  return times;
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&digit](const std::string& text, std::size_t& at) {
      std::size_t begin = at;
      while (at < text.size() && digit(text[at])) ++at;
      while (begin + 1 < at && text[begin] == '0') ++begin;
      return text.substr(begin, at - begin);
    };
    const std::string m = number(a, i), n = number(b, j);
    if (m.size() != n.size()) return m.size() < n.size();
    if (m != n) return m < n;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

void find_calibration(const std::vector<fs::path>& folders, Listing& listing) {
  for (const fs::path& folder : folders) {
    for (const char* name : {"calibration.yaml", "calibration.yml", "camera.yaml"}) {
      const fs::path file = folder / name;
      if (listing.calibration || !fs::exists(file)) continue;
      listing.calibration_name = file.string();
      listing.calibration = [file](const cv::Size& size) {
        return read_calibration_file(file, size);
      };
      listing.depth = [file](const cv::Size& size) { return read_depth_calibration(file, size); };
    }
  }
}

void find_groundtruth(const std::vector<fs::path>& folders, Listing& listing) {
  for (const fs::path& folder : folders) {
    for (const char* name : {"groundtruth.txt", "groundtruth_sfm.txt"}) {
      const fs::path file = folder / name;
      if (!fs::exists(file)) continue;
      if (!listing.groundtruth) {
        listing.groundtruth = file;
      } else {
        listing.more_groundtruth.push_back(file);
      }
    }
    if (listing.groundtruth) return;
  }
}

Listing list_images(const fs::path& folder_or_glob, double fps) {
  const bool glob = is_glob(folder_or_glob) && !fs::exists(folder_or_glob);
  fs::path folder = glob ? folder_or_glob.parent_path() : folder_or_glob;
  if (folder.empty()) folder = ".";
  folder = fs::absolute(folder).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // it ended in a slash
  const auto files =
      picture_files(folder, glob ? folder_or_glob.filename().string() : std::string());
  if (files.empty()) {
    throw Error(Error::Kind::kInput,
                folder_or_glob.string() +
                    (glob ? ": no file fits this pattern; check it (and quote it for the shell)"
                          : ": the folder holds no pictures, nor rgb.txt, mav0/ or sequences/; "
                            "name one that does"));
  }
  Listing listing;
  listing.name = folder.filename().string();
  listing.list = folder.string();
  find_calibration({folder, folder.parent_path()}, listing);
  find_groundtruth({folder, folder.parent_path()}, listing);
  if (fps <= 0) fps = 30;
  const auto times = times_of(files, fps);
  for (std::size_t i = 0; i < files.size(); ++i) {
    listing.pictures.push_back({times[i], files[i], ""});
  }
  // By name, 1.25 comes after 1.5.
  std::stable_sort(listing.pictures.begin(), listing.pictures.end(),
                   [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
  return listing;
}

}  // namespace cairn
