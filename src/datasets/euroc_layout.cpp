// EuRoC ASL: mav0/cam0/data.csv lists "nanoseconds,file", cam0/sensor.yaml has the camera.
#include <limits>

#include "cairn/datasets/layouts.h"
#include "cairn/datasets/text_lines.h"

namespace cairn {
namespace {

std::filesystem::path mav_folder(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "mav0") ? folder / "mav0" : folder;
}

}  // namespace

bool is_euroc(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(mav_folder(folder) / "cam0" / "data.csv");
}

Listing list_euroc(const std::filesystem::path& folder) {
  const auto mav = mav_folder(folder);
  const auto list = mav / "cam0" / "data.csv";
  Listing listing;
  listing.list = list.string();
  for (const TextLine& line : read_text_lines(list, "the list of pictures of the EuRoC layout")) {
    ListedPicture picture;
    const auto stamp = parse_integer(line.fields[0]);
    picture.timestamp = stamp ? double(*stamp) * 1e-9 : std::numeric_limits<double>::quiet_NaN();
    picture.file =
        mav / "cam0" / "data" / (line.fields.size() > 1 ? line.fields[1] : line.fields[0] + ".png");
    if (!stamp) {
      picture.problem = at_line(list, line.number) + ": \"" + line.fields[0] +
                        "\" is not a timestamp in whole nanoseconds";
    }
    listing.pictures.push_back(std::move(picture));
  }
  const auto sensor = mav / "cam0" / "sensor.yaml";
  if (std::filesystem::exists(sensor)) {
    listing.calibration_name = sensor.string();
    listing.calibration = [sensor](const cv::Size& size) {
      return read_calibration_file(sensor, size);
    };
  } else {
    find_calibration({folder, mav}, listing);
  }
  for (const char* name : {"state_groundtruth_estimate0", "mocap0"}) {
    const auto file = mav / name / "data.csv";
    if (!std::filesystem::exists(file)) continue;
    if (!listing.groundtruth) {
      listing.groundtruth = file;
    } else {
      listing.more_groundtruth.push_back(file);
    }
  }
  return listing;
}

}  // namespace cairn
