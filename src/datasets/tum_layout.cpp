// TUM RGB-D: rgb.txt lists "timestamp file", depth.txt and groundtruth.txt beside it.
#include <limits>

#include "cairn/datasets/layouts.h"
#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

// The colour calibrations that the data set publishes, for downloads as they are.
std::optional<Camera> published_camera(const std::string& name, const cv::Size& size) {
  using Values = std::array<double, 5>;
  const auto camera = [&](const Pinhole& pinhole, const Values& distortion) {
    return Camera(Camera::Model::kRadialTangential, size.width, size.height, pinhole, distortion);
  };
  if (size != cv::Size(640, 480)) return std::nullopt;
  if (name.find("freiburg1") != std::string::npos) {
    return camera({517.3, 516.5, 318.6, 255.3}, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633});
  }
  if (name.find("freiburg2") != std::string::npos) {
    return camera({520.9, 521.0, 325.1, 249.7}, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172});
  }
  if (name.find("freiburg3") != std::string::npos) {
    return camera({535.4, 539.2, 320.1, 247.6}, {});
  }
  return std::nullopt;
}

// Lines of a time and a file in the folder of the list.
std::vector<ListedPicture> read_list(const std::filesystem::path& list, const std::string& what) {
  std::vector<ListedPicture> pictures;
  for (const TextLine& line : read_text_lines(list, what, " \t")) {
    ListedPicture picture;
    const auto time = parse_number(line.fields[0]);
    picture.timestamp = time.value_or(kNoTime);
    std::string file;  // names may have spaces
    for (std::size_t i = 1; i < line.fields.size(); ++i)
      file += (i > 1 ? " " : "") + line.fields[i];
    picture.file = file.empty() ? list : list.parent_path() / file;
    if (!time) {
      picture.problem =
          at_line(list, line.number) + ": \"" + line.fields[0] + "\" is not a timestamp in seconds";
    } else if (file.empty()) {
      picture.problem = at_line(list, line.number) + ": no file name after the timestamp";
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace

bool is_tum(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(folder / "rgb.txt");
}

Listing list_tum(const std::filesystem::path& folder) {
  const auto list = folder / "rgb.txt";
  Listing listing;
  listing.list = list.string();
  listing.pictures = read_list(list, "the list of pictures");
  find_calibration({folder}, listing);
  find_groundtruth({folder}, listing);
  const std::string name = std::filesystem::absolute(folder).lexically_normal().string();
  if (!listing.calibration && published_camera(name, {640, 480})) {
    listing.calibration_name = "the published calibration of the data set";
    listing.calibration = [name](const cv::Size& size) {
      const auto camera = published_camera(name, size);
      if (!camera) {
        throw Error(Error::Kind::kUsage,
                    "the published calibration of this data set is for pictures of 640x480; give "
                    "one for these with --calibration");
      }
      return Calibration{*camera, std::nullopt, std::nullopt};
    };
  }
  return listing;
}

std::vector<ListedPicture> list_tum_depth(const std::filesystem::path& folder) {
  const auto list = folder / "depth.txt";
  if (!std::filesystem::is_regular_file(list)) {
    throw Error(Error::Kind::kInput,
                list.string() +
                    ": this list of measured depth is missing, which was asked for; "
                    "give a sequence of an RGB-D camera");
  }
  auto pictures = read_list(list, "the list of depth pictures");
  if (pictures.empty()) {
    throw Error(Error::Kind::kInput,
                list.string() + ": no depth picture is listed; check that the file is complete");
  }
  return pictures;
}

}  // namespace cairn
