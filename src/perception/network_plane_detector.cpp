#include "cairn/perception/network_plane_detector.h"

#include <spdlog/spdlog.h>

#include <future>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

std::vector<LabelledRegion> label_regions(const cv::Mat_<uchar>& labels,
                                          const std::vector<std::string>& planar_labels,
                                          int least) {
  std::vector<LabelledRegion> regions;
  const auto found = connected_regions(
      labels.size(), least, [&](const cv::Point& p) { return !planar_labels[labels(p)].empty(); },
      [&](const cv::Point& a, const cv::Point& b) { return labels(a) == labels(b); });
  regions.reserve(found.size());
  for (const GridRegion& pixels : found) {
    regions.push_back({pixels, planar_labels[labels(pixels.front())]});
  }
  return regions;
}

std::vector<LabelledRegion> unlabelled_regions(const cv::Mat& bgr, const cv::Size& grid, int least,
                                               double step) {
  cv::Mat small;
  cv::resize(bgr, small, grid, 0, 0, cv::INTER_AREA);
  if (small.channels() == 1) cv::cvtColor(small, small, cv::COLOR_GRAY2BGR);
  std::vector<LabelledRegion> regions;
  for (const GridRegion& pixels : colour_regions(small, least, step)) {
    regions.push_back({pixels, ""});
  }
  return regions;
}

}  // namespace

std::vector<DetectedPlane> planes_of_maps(const SceneMaps& maps,
                                          const std::vector<std::string>& planar_labels,
                                          const cv::Mat_<cv::Vec3f>& rays, const cv::Mat& bgr,
                                          const NetworkPlaneOptions& options) {
  OrganizedCloud cloud{rays, maps.depth.clone(), {}};
  for (int v = 0; v < rays.rows; ++v) {
    for (int u = 0; u < rays.cols; ++u) {
      if (rays(v, u)[2] == 0) cloud.depth(v, u) = 0;
    }
  }
  const PlaneHypothesisOptions& hypothesis = options.hypothesis;
  const cv::Mat_<cv::Vec3f> of_depth =
      normals_from_depth(rays, cloud.depth, hypothesis.noise, options.normals);
  cloud.normals = of_depth;
  // The hypotheses are independent, also in their normals where a network gives some.
  OrganizedCloud of_network = cloud;
  if (!maps.normals.empty()) of_network.normals = maps.normals;
  auto components =
      std::async(std::launch::async, [&] { return planes_of_components(cloud, hypothesis); });
  const int least = hypothesis.least_pixels(rays.size());
  const auto regions = maps.labels.empty()
                           ? unlabelled_regions(bgr, rays.size(), least, options.colour_step)
                           : label_regions(maps.labels, planar_labels, least);
  const auto of_regions = planes_of_regions(of_network, regions, hypothesis);
  auto agreed = agreeing_planes(cloud, of_regions, components.get(), hypothesis, options.agreement);
  merge_pieces(cloud, hypothesis, options.agreement, agreed);
  grow_rims(cloud, hypothesis, options.normals.radius_px, agreed);
  return detected_planes(cloud, bgr.size(), agreed, hypothesis, options.agreement);
}

NetworkPlaneDetector::NetworkPlaneDetector(SceneNetwork networks, const Camera& camera,
                                           const NetworkPlaneOptions& options)
    : networks_(std::move(networks)), options_(options) {
  if (!networks_.gives(NetworkCard::Kind::kDepth)) {
    throw Error(Error::Kind::kUsage,
                "planes: the networks give no depth; add a card of kind depth");
  }
  const int columns = options.grid_columns;
  rays_ = viewing_rays(camera, {columns, std::max(1, columns * camera.height() / camera.width())});
}

DetectedFrame NetworkPlaneDetector::detect(const PerceptionInput& input) {
  DetectedFrame frame;
  frame.timestamp = input.timestamp;
  const SceneMaps maps = networks_.look(input.bgr, rays_.size());
  if (!maps.problem.empty()) {
    frame.problem = maps.problem;
    spdlog::warn("planes: the picture at {:.6f} s is left out: {}", input.timestamp, maps.problem);
    return frame;
  }
  frame.planes = planes_of_maps(maps, networks_.planar_labels(), rays_, input.bgr, options_);
  frame.depth = maps.depth;
  frame.sigma_scale = maps.sigma_scale;
  return frame;
}

}  // namespace cairn
