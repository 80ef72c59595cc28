#include "cairn/datasets/sequence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cairn/datasets/calibration.h"
#include "cairn/datasets/capture_source.h"
#include "cairn/datasets/checked_source.h"
#include "cairn/datasets/layouts.h"
#include "cairn/datasets/measured_depth_source.h"
#include "cairn/datasets/picture_file.h"
#include "cairn/datasets/prefetching_source.h"
#include "cairn/geometry/error.h"
#include "cairn/geometry/median.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCameraPrefix = "camera:";

bool has_glob(const std::string& what) { return what.find_first_of("*?[") != std::string::npos; }

std::string recognise(const std::string& what) {
  if (what.starts_with(kCameraPrefix)) return "camera";
  std::error_code code;
  if (fs::is_directory(what, code)) {
    if (is_tum(what)) return "tum";
    if (is_euroc(what)) return "euroc";
    if (is_kitti(what)) return "kitti";
    return "images";
  }
  if (fs::exists(what, code)) {
    if (is_video_name(what)) return "video";
    throw Error(Error::Kind::kInput, what +
                                         ": this file is no video that is known by its name; "
                                         "name a folder, or say --layout video");
  }
  if (has_glob(what)) return "images";
  if (what.find("://") != std::string::npos) return "video";
  throw Error(Error::Kind::kInput, what + ": there is no such folder or file; check the path");
}

void check_layout(const std::string& layout) {
  constexpr std::array<std::string_view, 7> kLayouts = {"auto",   "tum",   "euroc", "kitti",
                                                        "images", "video", "camera"};
  if (std::find(kLayouts.begin(), kLayouts.end(), layout) != kLayouts.end()) return;
  throw Error(
      Error::Kind::kUsage,
      "--layout " + layout +
          ": there is no such layout; use auto, tum, euroc, kitti, images, video or camera");
}

std::string last_name(const fs::path& path) {
  const fs::path full = fs::absolute(path).lexically_normal();
  return full.has_filename() ? full.filename().string() : full.parent_path().filename().string();
}

// The size of the first picture that can be read; the camera's size and the other pictures must
// agree with it.
cv::Size first_size(const Listing& listing) {
  std::string first_problem;
  for (const ListedPicture& picture : listing.pictures) {
    std::string problem = picture.problem;
    const cv::Mat image = problem.empty() ? read_picture(picture.file, true, problem) : cv::Mat();
    if (problem.empty()) return image.size();
    if (first_problem.empty()) first_problem = problem;
  }
  if (listing.pictures.empty()) {
    throw Error(Error::Kind::kInput,
                listing.list + ": no picture is listed; check that the file is complete");
  }
  throw Error(Error::Kind::kInput, listing.list + ": not one of the " +
                                       std::to_string(listing.pictures.size()) +
                                       " pictures can be read; the first: " + first_problem);
}

// The camera by, in this order, the caller and the layout.
std::optional<double> set_camera(const OpenOptions& options, const Listing& listing,
                                 Sequence& sequence) {
  std::optional<double> fps;
  if (options.camera) {
    sequence.camera = options.camera;
    sequence.calibration = "the caller";
  } else if (!options.intrinsics.empty()) {
    sequence.camera = parse_camera(options.intrinsics, sequence.size.width, sequence.size.height);
    sequence.calibration = "--camera";
  } else if (!options.calibration.empty() || listing.calibration) {
    const bool own = options.calibration.empty();
    const Calibration calibration = own ? listing.calibration(sequence.size)
                                        : read_calibration_file(options.calibration, sequence.size);
    sequence.camera = calibration.camera;
    sequence.calibration = own ? listing.calibration_name : options.calibration.string();
    fps = calibration.fps;
  } else {
    return fps;
  }
  const cv::Size size(sequence.camera->width(), sequence.camera->height());
  if (size != sequence.size) {
    throw Error(Error::Kind::kUsage, "calibration (" + sequence.calibration + "): it is for " +
                                         in_pixels(size) + " pixels, but the pictures have " +
                                         in_pixels(sequence.size) +
                                         "; give the one of these pictures");
  }
  return fps;
}

// From the median step, which neither gaps nor broken times move.
double fps_of(const std::vector<ListedPicture>& pictures) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    const double step = pictures[i].timestamp - pictures[i - 1].timestamp;
    if (std::isfinite(step) && step > 1e-4) steps.push_back(step);
  }
  if (steps.empty()) return 30;
  return 1 / median(steps);
}

std::unique_ptr<FrameSource> safe_source(std::unique_ptr<FrameSource> source, const cv::Size& size,
                                         bool prefetch) {
  const bool ahead = prefetch && !source->live();
  source = std::make_unique<CheckedSource>(std::move(source), size);
  if (ahead) source = std::make_unique<PrefetchingSource>(std::move(source));
  return source;
}

Listing list_folder(const std::string& what, const std::string& layout, double fps) {
  std::error_code code;
  if (layout == "images") return list_images(what, fps);
  if (!fs::is_directory(what, code)) {
    throw Error(Error::Kind::kInput,
                what + ": there is no such folder, which the layout " + layout + " needs");
  }
  if (layout == "tum") return list_tum(what);
  if (layout == "euroc") return list_euroc(what);
  return list_kitti(what);
}

// The same source, with depth.
std::unique_ptr<FrameSource> with_depth(std::unique_ptr<FrameSource> source, const fs::path& folder,
                                        const OpenOptions& options, const Listing& listing,
                                        const Sequence& sequence) {
  DepthCalibration calibration;
  if (!options.calibration.empty()) {
    calibration = read_depth_calibration(options.calibration, sequence.size);
  } else if (listing.depth) {
    calibration = listing.depth(sequence.size);
  }
  return std::make_unique<MeasuredDepthSource>(std::move(source), list_tum_depth(folder),
                                               calibration, sequence.camera);
}

void check_depth(const std::string& what, const std::string& layout) {
  if (layout == "tum") return;
  throw Error(Error::Kind::kInput, what + ": the layout " + layout +
                                       " has no measured depth, which was asked for; give a "
                                       "sequence in TUM's layout, with depth.txt");
}

Sequence open_folder(const std::string& what, const std::string& layout,
                     const OpenOptions& options) {
  Listing listing = list_folder(what, layout, options.fps);
  Sequence sequence;
  sequence.size = first_size(listing);
  const auto said_fps = set_camera(options, listing, sequence);
  if (layout == "images" && options.fps <= 0 && said_fps) {
    listing.pictures = list_images(what, *said_fps).pictures;
  }
  sequence.name = listing.name.empty() ? last_name(what) : listing.name;
  sequence.groundtruth = listing.groundtruth;
  sequence.more_groundtruth = listing.more_groundtruth;
  sequence.fps = fps_of(listing.pictures);
  std::unique_ptr<FrameSource> frames =
      std::make_unique<PictureListSource>(std::move(listing.pictures), options.colour);
  if (options.depth) frames = with_depth(std::move(frames), what, options, listing, sequence);
  sequence.frames = safe_source(std::move(frames), sequence.size, options.prefetch);
  return sequence;
}

Sequence open_capture(const std::string& what, const std::string& layout,
                      const OpenOptions& options) {
  const bool live = layout == "camera";
  std::error_code code;
  if (!live && what.find("://") == std::string::npos && !fs::exists(what, code)) {
    throw Error(Error::Kind::kInput, what + ": there is no such video; check the path");
  }
  const std::string device =
      what.starts_with(kCameraPrefix) ? what.substr(kCameraPrefix.size()) : what;
  auto source = std::make_unique<CaptureSource>(
      device, live ? CaptureSource::Kind::kLive : CaptureSource::Kind::kFile, options.colour);
  Sequence sequence;
  sequence.size = source->picture_size();
  sequence.fps = source->fps();
  Listing listing;
  if (!live) {
    const fs::path file(what);
    const fs::path beside = fs::path(file).replace_extension(".yaml");
    if (fs::exists(beside, code)) {
      listing.calibration_name = beside.string();
      listing.calibration = [beside](const cv::Size& size) {
        return read_calibration_file(beside, size);
      };
    }
    find_calibration({fs::absolute(file).parent_path()}, listing);
    find_groundtruth({fs::absolute(file).parent_path()}, listing);
  }
  set_camera(options, listing, sequence);
  sequence.groundtruth = listing.groundtruth;
  sequence.more_groundtruth = listing.more_groundtruth;
  sequence.name = live ? "camera" : fs::path(what).stem().string();
  sequence.frames = safe_source(std::move(source), sequence.size, options.prefetch);
  return sequence;
}

}  // namespace

Sequence open_sequence(const std::string& what, const OpenOptions& options) {
  check_layout(options.layout);
  const std::string layout = options.layout == "auto" ? recognise(what) : options.layout;
  if (options.depth) check_depth(what, layout);
  Sequence sequence = layout == "video" || layout == "camera" ? open_capture(what, layout, options)
                                                              : open_folder(what, layout, options);
  sequence.layout = layout;
  return sequence;
}

}  // namespace cairn
