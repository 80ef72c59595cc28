// KITTI odometry: sequences/00/{image_0/, times.txt, calib.txt} and poses/00.txt.
#include <algorithm>
#include <cstdio>
#include <limits>

#include "cairn/datasets/layouts.h"
#include "cairn/datasets/picture_file.h"
#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

bool is_kitti_sequence(const fs::path& folder) {
  return fs::is_regular_file(folder / "times.txt") &&
         (fs::is_directory(folder / "image_0") || fs::is_directory(folder / "image_2"));
}

std::vector<fs::path> sequences_below(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder / "sequences", code)) {
    if (is_kitti_sequence(entry.path())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path sequence_folder(const fs::path& folder) {
  if (is_kitti_sequence(folder)) return folder;
  const auto found = sequences_below(folder);
  if (found.size() == 1) return found[0];
  if (found.empty()) {
    throw Error(Error::Kind::kInput,
                folder.string() +
                    ": this is no KITTI sequence; it needs times.txt and image_0/, "
                    "or a folder sequences/ with one that has them");
  }
  throw Error(Error::Kind::kInput, folder.string() + ": there are " + std::to_string(found.size()) +
                                       " sequences here; name one of them, such as " +
                                       found[0].string());
}

fs::path picture_of(const fs::path& images, std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu", number);
  for (const char* ending : {".png", ".jpg", ".jpeg"}) {
    const fs::path file = images / (std::string(name) + ending);
    if (fs::exists(file)) return file;
  }
  return images / (std::string(name) + ".png");
}

void list_pictures(const fs::path& images, const fs::path& times_file, Listing& listing) {
  const auto times = read_text_lines(times_file, "the list of timestamps of the KITTI layout");
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto time = parse_number(times[i].fields[0]);
    ListedPicture picture{time.value_or(std::numeric_limits<double>::quiet_NaN()),
                          picture_of(images, i), ""};
    if (!time) {
      picture.problem = at_line(times_file, times[i].number) + ": \"" + times[i].fields[0] +
                        "\" is not a timestamp in seconds";
    }
    listing.pictures.push_back(std::move(picture));
  }
  const auto files = std::count_if(fs::directory_iterator(images), fs::directory_iterator(),
                                   [](const auto& entry) { return is_picture_name(entry.path()); });
  for (std::size_t i = times.size(); i < std::size_t(files); ++i) {
    const fs::path picture = picture_of(images, i);
    listing.pictures.push_back(
        {std::numeric_limits<double>::quiet_NaN(), picture,
         picture.filename().string() + ": there is no timestamp for it in " + times_file.string()});
  }
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  return is_kitti_sequence(folder) || !sequences_below(folder).empty();
}

Listing list_kitti(const fs::path& folder) {
  const fs::path sequence = fs::absolute(sequence_folder(folder)).lexically_normal();
  const bool grey = fs::is_directory(sequence / "image_0");
  Listing listing;
  listing.list = (sequence / "times.txt").string();
  list_pictures(sequence / (grey ? "image_0" : "image_2"), sequence / "times.txt", listing);
  if (const auto file = sequence / "calib.txt"; fs::exists(file)) {
    listing.calibration_name = file.string();
    listing.calibration = [file, row = grey ? "P0" : "P2"](const cv::Size& size) {
      return Calibration{read_kitti_calibration(file, row, size), std::nullopt, std::nullopt};
    };
  } else {
    find_calibration({sequence, folder}, listing);
  }
  const fs::path trimmed = sequence.has_filename() ? sequence : sequence.parent_path();
  const fs::path poses =
      trimmed.parent_path().parent_path() / "poses" / (trimmed.filename().string() + ".txt");
  if (fs::exists(poses)) listing.groundtruth = poses;
  // "00" says little as a name: kitti_00.
  listing.name = "kitti_" + trimmed.filename().string();
  return listing;
}

}  // namespace cairn
