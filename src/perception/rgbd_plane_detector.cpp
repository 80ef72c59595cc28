#include "cairn/perception/rgbd_plane_detector.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

namespace cairn {
namespace {

constexpr float kJump = 0.05F;  // share of the depth, within a few pixels

std::string problem_of(const cv::Mat& depth, const Camera& camera) {
  if (depth.empty()) return "there is no measured depth";
  if (depth.type() != CV_32F) return "the measured depth is not in metres (CV_32F)";
  const double shape = double(depth.cols) * camera.height() / (double(depth.rows) * camera.width());
  if (std::abs(shape - 1) > 0.02) return "the measured depth has another shape than the picture";
  return "";
}

// The nearest measurement of each grid pixel: a mean across an edge would be of no surface.
cv::Mat_<float> sampled(const cv::Mat_<float>& depth, const cv::Mat_<cv::Vec3f>& rays) {
  cv::Mat_<float> result(rays.size(), 0.f);
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      const float z =
          depth(int((v + 0.5) * depth.rows / rays.rows), int((u + 0.5) * depth.cols / rays.cols));
      if (std::isfinite(z) && z > 0 && rays(v, u)[2] > 0) result(v, u) = z;
    }
  }
  return result;
}

// Corners are often at the rim of a thing, and half of them fall on what is behind it: then depth
// is always too large. Where it jumps it says nothing of a point.
cv::Mat without_jumps(const cv::Mat& depth) {
  const int reach = 2 * std::max(1, depth.cols / 200) + 1;
  const cv::Mat around(reach, reach, CV_8U, cv::Scalar(1));
  cv::Mat least, most, result = depth.clone();
  cv::erode(depth, least, around);  // unknown depth, as in the shadow of a thing, is a jump, too
  cv::dilate(depth, most, around);
  result.setTo(0, ~(most < (1 + kJump) * least));
  return result;
}

}  // namespace

RgbdPlaneDetector::RgbdPlaneDetector(const Camera& camera, std::optional<SceneNetwork> labels,
                                     const RgbdPlaneOptions& options)
    : camera_(camera), labels_(std::move(labels)), options_(options) {
  const int columns = std::min(options.grid_columns, camera.width());
  rays_ = viewing_rays(camera, {columns, std::max(1, columns * camera.height() / camera.width())});
}

void RgbdPlaneDetector::name_planes(const cv::Mat& bgr, std::vector<AgreedPlane>& planes) {
  if (!labels_ || bgr.empty() || !labels_->gives(NetworkCard::Kind::kLabels)) return;
  const SceneMaps maps = labels_->look(bgr, rays_.size());
  if (!maps.problem.empty()) {
    spdlog::warn("planes: a picture stays without labels: {}", maps.problem);
    return;
  }
  for (AgreedPlane& plane : planes) {
    std::map<int, int> votes;
    for (const cv::Point& p : plane.plane.pixels) ++votes[maps.labels(p)];
    const auto winner = std::max_element(votes.begin(), votes.end(),
                                         [](auto& a, auto& b) { return a.second < b.second; });
    plane.plane.label = labels_->planar_labels()[std::size_t(winner->first)];
  }
}

DetectedFrame RgbdPlaneDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame;
  frame.timestamp = input.timestamp;
  frame.problem = problem_of(input.depth, camera_);
  if (!frame.problem.empty()) {
    spdlog::warn("planes: the picture at {:.6f} s is left out: {}", input.timestamp, frame.problem);
    return frame;
  }
  OrganizedCloud cloud{rays_, sampled(input.depth, rays_), {}};
  cloud.normals =
      normals_from_depth(rays_, cloud.depth, options_.hypothesis.noise, options_.normals);
  std::vector<AgreedPlane> planes;
  for (PlaneHypothesis& plane : planes_of_components(cloud, options_.hypothesis)) {
    const auto fit = fit_region(cloud, plane.pixels, options_.hypothesis);
    if (!fit || fit->inlier_share < options_.agreement.min_inlier_share) continue;
    plane.plane = fit->plane;
    planes.push_back({std::move(plane), fit->inlier_share});
  }
  merge_pieces(cloud, options_.hypothesis, options_.agreement, planes);
  grow_rims(cloud, options_.hypothesis, options_.normals.radius_px, planes);
  name_planes(input.bgr, planes);
  const cv::Size picture = input.bgr.empty() ? input.depth.size() : input.bgr.size();
  frame.planes = detected_planes(cloud, picture, planes, options_.hypothesis, options_.agreement);
  frame.depth = without_jumps(input.depth);
  return frame;
}

}  // namespace cairn
