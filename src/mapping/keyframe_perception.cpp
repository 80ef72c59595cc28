#include "cairn/mapping/keyframe_perception.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cairn/mapping/hung_things.h"
#include "cairn/mapping/seen_objects.h"
#include "cairn/perception/picture_box.h"

namespace cairn {
namespace {

constexpr double kMinGrazing = 0.05;   // cosine between ray and normal: flatter says nothing
constexpr double kMaxStretch = 2.5;    // depth of a corner over that of the centroid
constexpr double kLeastSigma = 0.002;  // no surface is flatter: radians, and share of the distance
constexpr double kOutlineError = 4.0;  // pixels that a simplified outline may be off
// Masks are ragged by 1.25 % of the root of their area (docs/perception_noise.md), and keypoints of
// what stands in front lie somewhat beside it: within twice that they may belong to either.
constexpr double kRim = 0.025;

// Where the ray of a pixel meets a plane; nothing behind the camera or along the plane.
std::optional<Eigen::Vector3d> meet(const Plane& plane, const Eigen::Vector3d& ray) {
  const double along = plane.normal().dot(ray);
  if (std::abs(along) < kMinGrazing * ray.norm()) return std::nullopt;
  const double depth = -plane.offset() / along;
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return Eigen::Vector3d(depth * ray);
}

// Keypoints are where an ideal pinhole sees them; pictures have the bend of the lens.
std::vector<cv::Point> pixels_in_picture(const Frame& frame, const Camera& camera, const View& view,
                                         cv::Size size) {
  const double sx = double(size.width) / camera.width(), sy = double(size.height) / camera.height();
  std::vector<cv::Point> pixels;
  pixels.reserve(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Eigen::Vector2d uv = camera.project(view.pinhole().unproject(frame.sighted_pixel(i)));
    pixels.emplace_back(std::clamp(cvRound((uv.x() + 0.5) * sx - 0.5), 0, size.width - 1),
                        std::clamp(cvRound((uv.y() + 0.5) * sy - 0.5), 0, size.height - 1));
  }
  return pixels;
}

// Corners of the largest part of the mask, on the plane; those far beyond the rest are left out.
void find_extent(const cv::Mat& mask, const Camera& camera, SeenPlane& plane) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  const auto largest = std::max_element(contours.begin(), contours.end(), [](auto& a, auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
  if (largest == contours.end()) return;
  const cv::Moments m = cv::moments(*largest);
  if (!(m.m00 > 0)) return;
  const auto on_plane = [&](double x, double y) {
    return meet(plane.plane, camera.unproject({x, y}));
  };
  const auto centroid = on_plane(m.m10 / m.m00, m.m01 / m.m00);
  if (!centroid) return;
  plane.centroid = *centroid;
  std::vector<cv::Point> corners;
  cv::approxPolyDP(*largest, corners, kOutlineError, true);
  for (const cv::Point& corner : corners) {
    const auto x = on_plane(corner.x, corner.y);
    if (x && x->z() < kMaxStretch * centroid->z()) plane.outline.push_back(*x);
  }
}

DepthRange range_of(const cv::Mat_<float>& depth) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const float d : depth) {
    if (!(d > 0) || !std::isfinite(d)) continue;
    const double log_depth = std::log(d);
    sum += log_depth;
    squares += log_depth * log_depth;
    ++count;
  }
  if (count == 0) return {};
  const double mean = sum / count;
  return {mean, std::max(squares / count - mean * mean, 0.0)};
}

std::optional<SeenPlane> look_at(const DetectedPlane& detected, const Camera& camera,
                                 const std::vector<cv::Point>& pixels) {
  const double norm = detected.plane.head<3>().norm();
  if (!detected.plane.allFinite() || !(norm > 0)) return std::nullopt;
  if (detected.mask.type() != CV_8U ||
      detected.mask.size() != cv::Size(camera.width(), camera.height())) {
    return std::nullopt;
  }
  SeenPlane seen;
  seen.plane = Plane(detected.plane.head<3>() / norm, detected.plane[3] / norm);
  seen.label = detected.label;
  seen.score = detected.score;
  find_extent(detected.mask, camera, seen);
  if (seen.outline.size() < 3 || !(seen.centroid.z() > 0)) return std::nullopt;
  if (!std::isfinite(detected.sigma_angle + detected.sigma_depth)) return std::nullopt;
  seen.sigma_angle = std::max(detected.sigma_angle, kLeastSigma);
  seen.sigma_offset = std::max(detected.sigma_depth, kLeastSigma) * seen.centroid.norm();
  const double rim = kRim * std::sqrt(cv::countNonZero(detected.mask));
  const cv::Rect near = surroundings(detected.mask, int(rim) + 2);
  const cv::Mat mask = detected.mask(near);
  cv::Mat_<float> inside, outside;  // pixels to the mask's border
  cv::distanceTransform(mask, inside, cv::DIST_L2, 3);
  cv::distanceTransform(mask == 0, outside, cv::DIST_L2, 3);
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    if (!near.contains(pixels[i])) continue;
    const cv::Point at = pixels[i] - near.tl();
    if (inside(at) > 0) seen.keypoints.push_back(i);
    if (inside(at) > rim) seen.inner.push_back(i);
    if (outside(at) > 0 && outside(at) <= rim) seen.beside.push_back(i);
  }
  return seen;
}

}  // namespace

KeyframePerception summarize_perception(const DetectedFrame& detected,
                                        std::shared_ptr<const Frame> frame, const Camera& camera,
                                        const View& view) {
  KeyframePerception summary;
  summary.sigma_scale = detected.sigma_scale;
  summary.depth.assign(frame->size(), 0);
  if (detected.depth.type() == CV_32F && !detected.depth.empty()) {
    summary.range = range_of(detected.depth);
    const auto pixels = pixels_in_picture(*frame, camera, view, detected.depth.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const float depth = detected.depth.at<float>(pixels[i]);
      if (std::isfinite(depth) && depth > 0) summary.depth[i] = depth;
    }
  }
  const auto pixels =
      pixels_in_picture(*frame, camera, view, cv::Size(camera.width(), camera.height()));
  const cv::Mat_<int> hung = hung_things(detected.planes, {camera.width(), camera.height()});
  for (std::size_t index = 0; index < detected.planes.size(); ++index) {
    auto seen = look_at(detected.planes[index], camera, pixels);
    if (!seen) continue;
    for (std::uint32_t i = 0; i < pixels.size(); ++i) {
      if (hung(pixels[i]) == int(index)) seen->keypoints.push_back(i);
    }
    if (detected.depth.empty()) {
      for (const std::uint32_t i : seen->keypoints) {
        const auto x = meet(seen->plane, view.pinhole().unproject(frame->pixel(i)));
        if (x) summary.depth[i] = static_cast<float>(x->z());
      }
    }
    summary.planes.push_back(std::move(*seen));
  }
  summary.objects = see_objects(detected.objects, *frame, camera, view);
  summary.frame = std::move(frame);
  return summary;
}

}  // namespace cairn
