#include "cairn/mapping/seen_objects.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cairn {
namespace {

// By what edges are off: a pixel, and a share of the box's size, of detectors' errors 0.03
// (docs/perception_noise.md, `boxes.lasting`, `floor_px`), and as things are no ellipsoids 0.04.
constexpr double kEdgeShare = 0.05, kEdgeFloor = 1;
constexpr double kBorder = 2;  // pixels: edges nearer to the border, or within σ, are cut by it
constexpr int kSteps = 4;      // along each edge

std::optional<Box2> undistorted(const Box2& box, const Camera& camera) {
  Box2 result{1e300, 1e300, -1e300, -1e300};
  for (int i = 0; i <= kSteps; ++i) {
    const double x = box.x0 + box.width() * i / kSteps, y = box.y0 + box.height() * i / kSteps;
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(x, box.y0), Eigen::Vector2d(x, box.y1),
                                      Eigen::Vector2d(box.x0, y), Eigen::Vector2d(box.x1, y)}) {
      const Eigen::Vector2d uv = camera.undistort(at);
      if (!uv.allFinite()) return std::nullopt;
      result = {std::min(result.x0, uv.x()), std::min(result.y0, uv.y()),
                std::max(result.x1, uv.x()), std::max(result.y1, uv.y())};
    }
  }
  return result;
}

}  // namespace

std::vector<SeenObject> see_objects(std::span<const DetectedObject> detected, const Frame& frame,
                                    const Camera& camera, const View& view) {
  const Box2 picture{0, 0, camera.width() - 1.0, camera.height() - 1.0};
  std::vector<SeenObject> objects;
  for (const DetectedObject& d : detected) {
    if (!d.box.valid() || !std::isfinite(d.score) || !(d.score > 0)) continue;
    const std::optional<Box2> box = undistorted(d.box, camera);
    if (!box || !box->valid()) continue;
    SeenObject seen;
    seen.box = *box;
    seen.sigma = std::hypot(kEdgeFloor, kEdgeShare * (box->width() + box->height()) / 2);
    // Detectors leave a gap between the border and a thing that goes on beyond it.
    const double border = std::max(kBorder, seen.sigma);
    const bool left = d.box.x0 < picture.x0 + border, top = d.box.y0 < picture.y0 + border;
    const bool right = d.box.x1 > picture.x1 - border, bottom = d.box.y1 > picture.y1 - border;
    seen.cut = {left, top, right, bottom};
    seen.class_name = d.class_name;
    seen.score = d.score;
    seen.thing = d.thing;
    for (std::uint32_t i = 0; i < frame.size(); ++i) {
      const Eigen::Vector2d uv = frame.sighted_pixel(i);
      if (view.contains(uv) && box->contains(uv)) seen.keypoints.push_back(i);
    }
    objects.push_back(std::move(seen));
  }
  return objects;
}

}  // namespace cairn
