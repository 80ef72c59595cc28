#include "cairn/evaluation/measured_planes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "cairn/evaluation/outline.h"
#include "cairn/evaluation/trajectory_error.h"
#include "cairn/geometry/plane_fit.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

nlohmann::json number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace

MeasuredPlanes::MeasuredPlanes(std::vector<FoundPlane> planes, const MeasuredPlaneOptions& options)
    : options_(options), planes_(std::move(planes)), points_(planes_.size()) {
  for (const FoundPlane& plane : planes_) {
    rims_.push_back(options_.rim * std::sqrt(area(plane.outline)));
  }
}

// `normal`: unit, of the surface around x, whichever side it points to.
void MeasuredPlanes::add_point(const Vector3d& x, const Vector3d& normal) {
  const double least = std::cos(options_.max_turn_deg * M_PI / 180);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const FoundPlane& plane = planes_[i];
    const double distance = plane.normal.dot(x) + plane.d;
    if (!(std::abs(distance) < options_.max_distance)) continue;
    if (!(std::abs(plane.normal.dot(normal)) > least)) continue;
    const Vector3d on_plane = x - distance * plane.normal;
    if (distance_outside(on_plane, plane.outline, plane.normal) < -rims_[i]) {
      points_[i].push_back(x);
    }
  }
}

void MeasuredPlanes::add(const cv::Mat& depth, const Camera& camera, const SE3& T_wc) {
  assert(depth.type() == CV_32F && depth.size() == cv::Size(camera.width(), camera.height()));
  ++pictures_;
  // NaN where nothing is measured, which no comparison lets through.
  const auto point = [&](int u, int v) -> Vector3d {
    const double z = depth.at<float>(v, u);
    const Vector3d ray = camera.unproject({double(u), double(v)});
    return (z > 0 ? z : std::nan("")) / ray.z() * ray;
  };
  const int step = options_.pixel_step;
  for (int v = step / 2; v + step < depth.rows; v += step) {
    for (int u = step / 2; u + step < depth.cols; u += step) {
      const Vector3d x = point(u, v);
      const Vector3d normal = (point(u + step, v) - x).cross(point(u, v + step) - x).normalized();
      add_point(T_wc * x, T_wc.rotation() * normal);
    }
  }
}

MeasuredPlane MeasuredPlanes::measure(std::size_t plane) const {
  const FoundPlane& found = planes_[plane];
  MeasuredPlane result;
  result.id = found.id;
  result.label = found.label;
  const PlaneFit fit =
      fit_plane_robustly(points_[plane], {}, {.max_distance = options_.gate}, plane);
  if (!fit.usable) return result;
  result.points = std::size_t(fit.inliers);
  result.share = double(fit.inliers) / double(points_[plane].size());
  if (result.points < options_.min_points) return result;
  result.angle_deg = angle_between(fit.plane, Plane(found.normal, found.d)) * 180 / M_PI;
  result.offset = std::abs(fit.plane.signed_distance(middle(found.outline)));
  return result;
}

MeasuredPlaneReport MeasuredPlanes::report() const {
  MeasuredPlaneReport report;
  report.pictures = pictures_;
  std::vector<double> angles, offsets;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const MeasuredPlane& plane = report.planes.emplace_back(measure(i));
    if (!plane.offset) continue;
    angles.push_back(*plane.angle_deg);
    offsets.push_back(*plane.offset);
  }
  if (angles.empty()) return report;
  report.angle_deg = statistics(angles).median;
  report.offset = statistics(offsets).median;
  return report;
}

nlohmann::json to_json(const MeasuredPlaneReport& report) {
  nlohmann::json planes = nlohmann::json::array();
  std::size_t measured = 0;
  for (const MeasuredPlane& plane : report.planes) {
    measured += plane.offset.has_value();
    planes.push_back({{"id", plane.id},
                      {"label", plane.label},
                      {"points", plane.points},
                      {"share", plane.share},
                      {"angle_deg", number(plane.angle_deg)},
                      {"offset", number(plane.offset)}});
  }
  return {{"measured_planes",
           {{"pictures", report.pictures},
            {"measured", measured},
            {"angle_deg", number(report.angle_deg)},
            {"offset", number(report.offset)},
            {"planes", planes}}}};
}

std::string to_table(const MeasuredPlaneReport& report) {
  std::string table = line("  planes against depth of %zu pictures:\n", report.pictures);
  table += "    id  label         points  share      angle     offset\n";
  for (const MeasuredPlane& plane : report.planes) {
    table += line("  %4d  %-10.10s  %8zu", plane.id, plane.label.c_str(), plane.points);
    table += plane.offset ? line("  %3.0f %%  %6.2f deg  %7.4f m\n", 100 * plane.share,
                                 *plane.angle_deg, *plane.offset)
                          : "  not measured\n";
  }
  if (!report.offset) return table + "    no plane is measured\n";
  return table + line("        median                    %6.2f deg  %7.4f m\n", *report.angle_deg,
                      *report.offset);
}

}  // namespace cairn
