#include "cairn/datasets/measured_depth_source.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairn/datasets/picture_file.h"

namespace cairn {
namespace {

constexpr double kMaxDifference = 0.02;  // seconds, as in TUM's associate.py

// Metres, 0 where unknown. The largest number is what sensors give where they saw nothing.
cv::Mat_<float> in_metres(const cv::Mat_<std::uint16_t>& steps, double scale) {
  cv::Mat_<float> metres;
  steps.convertTo(metres, CV_32F, 1 / scale);
  metres.setTo(0, steps == std::numeric_limits<std::uint16_t>::max());
  return metres;
}

}  // namespace

MeasuredDepthSource::MeasuredDepthSource(std::unique_ptr<FrameSource> source,
                                         std::vector<ListedPicture> depth,
                                         const DepthCalibration& calibration,
                                         const std::optional<Camera>& colour)
    : source_(std::move(source)), depth_(std::move(depth)), scale_(calibration.scale) {
  std::erase_if(depth_, [](const ListedPicture& p) { return !std::isfinite(p.timestamp); });
  std::stable_sort(depth_.begin(), depth_.end(),
                   [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
  if (!calibration.camera || !colour) return;
  registration_.emplace(*colour, *calibration.camera, calibration.T_color_depth);
  depth_size_ = {calibration.camera->width(), calibration.camera->height()};
}

const ListedPicture* MeasuredDepthSource::nearest(double timestamp) const {
  const auto later = std::lower_bound(
      depth_.begin(), depth_.end(), timestamp,
      [](const ListedPicture& picture, double time) { return picture.timestamp < time; });
  const ListedPicture* best = nullptr;
  double least = kMaxDifference;
  for (auto it = later == depth_.begin() ? later : later - 1; it != depth_.end(); ++it) {
    const double difference = std::abs(it->timestamp - timestamp);
    if (difference <= least) best = &*it, least = difference;
    if (it->timestamp >= timestamp) break;
  }
  return best;
}

cv::Mat MeasuredDepthSource::read(const SourceFrame& frame, std::string& problem) const {
  const ListedPicture* picture = nearest(frame.timestamp);
  if (picture == nullptr) {
    problem = frame.name + ": no depth picture is within 0.02 s of it";
    return {};
  }
  problem = picture->problem;
  const cv::Mat steps = problem.empty() ? read_depth_picture(picture->file, problem) : cv::Mat();
  if (!problem.empty()) return {};
  const cv::Size wanted = registration_ ? depth_size_ : frame.image.size();
  if (steps.size() != wanted) {
    problem = picture->file.string() + ": the depth picture is " + in_pixels(steps.size()) +
              (registration_ ? ", but the depth camera of the calibration is for "
                             : ", and the calibration has no depth camera (depth:) for it; of the "
                               "colour camera it would be ") +
              in_pixels(wanted);
    return {};
  }
  const cv::Mat_<float> metres = in_metres(steps, scale_);
  return registration_ ? (*registration_)(metres) : metres;
}

bool MeasuredDepthSource::next(SourceFrame& frame) {
  if (!source_->next(frame)) return false;
  frame.depth.release();
  frame.depth_problem.clear();
  if (frame.problem.empty()) frame.depth = read(frame, frame.depth_problem);
  return true;
}

}  // namespace cairn
