#include "cairn/output/outline_projection.h"

#include <algorithm>
#include <array>

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr double kBeyond = 0.02;  // of the picture's size: where the cuts are
constexpr double kNear = 1e-3;    // units of the map
constexpr double kAskance = 0.2;  // cosine to the optical axis: a fisheye's border is cut there
constexpr int kSteps = 12;        // along an edge, which the lens may bend

// What the camera sees at depth 1.
Eigen::AlignedBox2d field_of_view(const Camera& camera) {
  Eigen::AlignedBox2d field;
  const auto extend = [&](double u, double v) {
    const Vector3d ray = camera.unproject({u * camera.width(), v * camera.height()});
    if (ray.allFinite()) field.extend(ray.head<2>() / std::max(ray.z(), kAskance));
  };
  for (int i = 0; i <= kSteps; ++i) {
    const double along = -kBeyond + (1 + 2 * kBeyond) * i / kSteps;
    for (const double border : {-kBeyond, 1 + kBeyond}) {
      extend(along, border);
      extend(border, along);
    }
  }
  return field;
}

// The part with inward · x >= least (Sutherland and Hodgman 1974).
std::vector<Vector3d> clipped(const std::vector<Vector3d>& polygon, const Vector3d& inward,
                              double least) {
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double inside_a = inward.dot(a) - least, inside_b = inward.dot(b) - least;
    if (inside_a >= 0) kept.push_back(a);
    if ((inside_a >= 0) != (inside_b >= 0)) {
      kept.emplace_back(a + inside_a / (inside_a - inside_b) * (b - a));
    }
  }
  return kept;
}

}  // namespace

std::vector<cv::Point2f> project_outline(std::span<const Vector3d> outline, const SE3& T_cw,
                                         const Camera& camera) {
  std::vector<Vector3d> polygon;
  for (const Vector3d& corner : outline) polygon.push_back(T_cw * corner);
  polygon = clipped(polygon, Vector3d::UnitZ(), kNear);
  const Eigen::AlignedBox2d field = field_of_view(camera);
  polygon = clipped(polygon, {1, 0, -field.min().x()}, 0);
  polygon = clipped(polygon, {-1, 0, field.max().x()}, 0);
  polygon = clipped(polygon, {0, 1, -field.min().y()}, 0);
  polygon = clipped(polygon, {0, -1, field.max().y()}, 0);
  std::vector<cv::Point2f> pixels;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector2f pixel = camera.project(a + double(k) / kSteps * (b - a)).cast<float>();
      pixels.emplace_back(pixel.x(), pixel.y());
    }
  }
  return pixels;
}

}  // namespace cairn
