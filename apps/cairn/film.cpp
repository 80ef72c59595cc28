#include "film.h"

#include <algorithm>

#include "cairn/output/ellipsoid_outline.h"
#include "cairn/output/outline_projection.h"
#include "cairn/output/overlay.h"

namespace cairn::app {
namespace {

constexpr std::size_t kStills = 6;

void add_planes(const FrameResult& result, const MapView* map, const Camera& camera,
                FrameOverlay& overlay) {
  for (const DetectedPlane& plane : result.planes) {
    if (plane.mask.size() != cv::Size(camera.width(), camera.height())) continue;
    overlay.masks.push_back({plane.label, plane.mask});
  }
  if (!overlay.masks.empty() || map == nullptr || !result.T_wc) return;
  for (const MapView::PlanePose& plane : map->planes) {
    if (!plane.confirmed) continue;
    auto corners = project_outline(plane.outline, result.T_wc->inverse(), camera);
    if (!corners.empty()) overlay.outlines.push_back({plane.label, std::move(corners)});
  }
}

void add_objects(const FrameResult& result, const MapView* map, const Camera& camera,
                 FrameOverlay& overlay) {
  for (const DetectedObject& object : result.objects) overlay.boxes.push_back(object.box);
  if (map == nullptr || !result.T_wc) return;
  for (const MapView::ObjectPose& object : map->objects) {
    auto corners = project_ellipsoid(object.ellipsoid, result.T_wc->inverse(), camera);
    if (!corners.empty()) overlay.objects.push_back({object.class_name, std::move(corners)});
  }
}

}  // namespace

Film::Film(const std::filesystem::path& folder, const Camera& camera, double fps)
    : folder_(folder), camera_(camera), video_(folder / "video.mp4", fps) {}

void Film::add(const cv::Mat& image, const FrameResult& result, const MapView* map) {
  FrameOverlay overlay;
  add_planes(result, map, camera_, overlay);
  add_objects(result, map, camera_, overlay);
  for (const auto& f : result.features) overlay.features.push_back({f.x, f.y, f.mapped});
  overlay.state = to_string(result.record.state);
  overlay.matches = result.record.inliers;
  overlay.fps = result.record.total_ms > 0 ? 1000 / result.record.total_ms : 0;
  overlay.timestamp = result.record.timestamp;
  const cv::Mat picture = draw_overlay(image, overlay);
  video_.write(picture);
  keep_still(picture);
}

// Evenly spread over a film whose length is not known: each time there are too many, every other
// one goes.
void Film::keep_still(const cv::Mat& picture) {
  if (count_++ % stride_ != 0) return;
  stills_.push_back(picture);
  if (stills_.size() < 2 * kStills) return;
  for (std::size_t i = 0; i < kStills; ++i) stills_[i] = stills_[2 * i];
  stills_.resize(kStills);
  stride_ *= 2;
}

void Film::finish() {
  video_.finish();
  if (stills_.empty()) return;
  std::vector<cv::Mat> chosen;
  const std::size_t n = std::min(kStills, stills_.size());
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(stills_[i * stills_.size() / n]);
  write_strip(folder_ / "strip.jpg", chosen, 3);
}

}  // namespace cairn::app
