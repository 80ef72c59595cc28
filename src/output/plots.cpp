#include "cairn/output/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "cairn/geometry/error.h"
#include "cairn/geometry/median.h"
#include "cairn/output/atomic_file.h"
#include "cairn/output/chart.h"
#include "cairn/output/ellipsoid_outline.h"
#include "cairn/output/number_text.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

const cv::Point2d kBreak(std::numeric_limits<double>::quiet_NaN(),
                         std::numeric_limits<double>::quiet_NaN());

// Wide and below the estimate, so that it is seen where both agree.
constexpr double kTruthWidth = 4.5;
constexpr double kSmallError = 0.1;  // metres, below which it is given in millimetres

cv::Point2d from_above(const PlanView& view, const Vector3d& x) {
  return {view.right.dot(x), view.forward.dot(x)};
}

// A step in time of more than five usual ones is a loss: no line is drawn over it.
double longest_step(const Trajectory& trajectory) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    steps.push_back(trajectory[i].timestamp - trajectory[i - 1].timestamp);
  }
  if (steps.empty()) return 0;
  return std::max(5 * median(steps), 0.25);
}

template <typename ToPoint>
std::vector<cv::Point2d> line_of(const Trajectory& trajectory, ToPoint&& to_point) {
  const double longest = longest_step(trajectory);
  std::vector<cv::Point2d> points;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].timestamp - trajectory[i - 1].timestamp > longest) {
      points.push_back(kBreak);
    }
    points.push_back(to_point(trajectory[i]));
  }
  return points;
}

// The part of the truth that the estimate can be compared with, a little more at both ends.
Trajectory truth_beside(const PlotScene& scene) {
  if (scene.estimate.empty()) return scene.truth;
  Trajectory part;
  for (const StampedPose& pose : scene.truth) {
    if (pose.timestamp >= scene.estimate.front().timestamp - 1 &&
        pose.timestamp <= scene.estimate.back().timestamp + 1) {
      part.push_back(pose);
    }
  }
  return part;
}

Chart plan_chart(const PlotScene& scene) {
  Chart chart;
  chart.equal_scale = true;
  chart.x_label = scene.view.right_name + " [" + scene.unit + "]";
  chart.y_label = scene.view.forward_name + " [" + scene.unit + "]";
  return chart;
}

double quantile_or_zero(std::vector<double> values, double rank) {
  return values.empty() ? 0 : quantile(values, rank);
}

// Points at infinity and wild ones would shrink the rest to a dot: kept is what lies within twice
// the range of the middle nine tenths, and the surroundings of the path.
std::vector<std::size_t> points_in_view(const PlotScene& scene) {
  std::array<std::pair<double, double>, 3> limits;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vector3d& x : scene.points) values.push_back(x[axis]);
    double low = quantile_or_zero(values, 0.05), high = quantile_or_zero(values, 0.95);
    for (const StampedPose& pose : scene.keyframes) {
      low = std::min(low, pose.T_wc.translation()[axis]);
      high = std::max(high, pose.T_wc.translation()[axis]);
    }
    const double margin = 0.5 * (high - low);
    limits[std::size_t(axis)] = {low - margin, high + margin};
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& [low, high] = limits[std::size_t(axis)];
      const double value = scene.points[i][axis];
      inside = inside && value >= low && value <= high;
    }
    if (inside) kept.push_back(i);
  }
  return kept;
}

// Dots of the map, the lowest first so that the highest lie on top.
void add_points(const PlotScene& scene, Chart& chart) {
  std::vector<std::size_t> kept = points_in_view(scene);
  const auto height = [&](std::size_t i) { return scene.view.up.dot(scene.points[i]); };
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return height(a) < height(b); });
  std::vector<double> heights;
  heights.reserve(kept.size());
  for (const std::size_t i : kept) heights.push_back(height(i));
  const double low = quantile_or_zero(heights, 0.02), high = quantile_or_zero(heights, 0.98);
  const bool by_height = scene.point_colours.size() != scene.points.size();
  ChartSeries dots{"", {}, colours::kTruth, false, kept.size() > 20000 ? 1.4 : 2.4, {}, false};
  for (const std::size_t i : kept) {
    dots.points.push_back(from_above(scene.view, scene.points[i]));
    if (by_height) {
      dots.colours.push_back(ramp_colour((height(i) - low) / std::max(high - low, 1e-9)));
    } else {
      const Rgb& rgb = scene.point_colours[i];
      dots.colours.emplace_back(rgb.z(), rgb.y(), rgb.x());
    }
  }
  if (by_height && !kept.empty()) {
    chart.colour_range = {low, high};
    chart.colour_label = "height [" + scene.unit + "]";
  }
  chart.series.push_back(std::move(dots));
}

void add_planes(const PlotScene& scene, Chart& chart) {
  std::set<std::string> named;  // one entry a label in the legend
  for (const PlotScene::PlaneOutline& plane : scene.planes) {
    if (plane.outline.empty()) continue;
    ChartSeries edge{named.insert(plane.label).second ? plane.label : "",
                     {},
                     cv::Scalar(plane.colour.z(), plane.colour.y(), plane.colour.x())};
    for (const Vector3d& corner : plane.outline) {
      edge.points.push_back(from_above(scene.view, corner));
    }
    edge.points.push_back(edge.points.front());
    edge.filled = true;
    chart.series.push_back(std::move(edge));
  }
}

void add_objects(const PlotScene& scene, Chart& chart) {
  for (const PlotScene::Object& object : scene.objects) {
    ChartSeries edge{"", {}, cv::Scalar(object.colour.z(), object.colour.y(), object.colour.x())};
    for (const Eigen::Vector2d& p :
         ellipsoid_shadow(object.ellipsoid, scene.view.right, scene.view.forward)) {
      edge.points.emplace_back(p.x(), p.y());
    }
    edge.filled = true;
    edge.inscription = object.label;
    chart.series.push_back(std::move(edge));
  }
}

}  // namespace

PlanView PlanView::z_up() {
  return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), "x", "y", "z"};
}

PlanView PlanView::from_cameras(const Trajectory& trajectory) {
  Vector3d up = Vector3d::Zero();
  for (const StampedPose& pose : trajectory) {
    up -= pose.T_wc.rotation() * Vector3d::UnitY();
  }
  Eigen::Index axis = 1;
  if (up.norm() < 1e-9 || up.cwiseAbs().maxCoeff(&axis) <= 0) return first_camera();
  const double sign = up[axis] > 0 ? 1 : -1;
  const std::array<const char*, 3> names = {"x", "y", "z"};
  PlanView view;
  view.up = sign * Vector3d::Unit(axis);
  view.up_name = std::string(sign > 0 ? "" : "-") + names[std::size_t(axis)];
  // One of the other axes to the right, and forward what completes a right-handed frame.
  const Eigen::Index right = axis == 0 ? 1 : 0;
  view.right = Vector3d::Unit(right);
  view.right_name = names[std::size_t(right)];
  view.forward = view.up.cross(view.right);
  Eigen::Index forward = 0;
  view.forward.cwiseAbs().maxCoeff(&forward);
  view.forward_name =
      std::string(view.forward[forward] > 0 ? "" : "-") + names[std::size_t(forward)];
  return view;
}

cv::Mat draw_trajectory_plot(const PlotScene& scene) {
  const auto above = [&](const StampedPose& pose) {
    return from_above(scene.view, pose.T_wc.translation());
  };
  double start = std::numeric_limits<double>::infinity();
  for (const Trajectory* t : {&scene.estimate, &scene.truth}) {
    if (!t->empty() && (t == &scene.estimate || scene.estimate.empty())) {
      start = std::min(start, t->front().timestamp);
    }
  }
  const auto height = [&](const StampedPose& pose) {
    return cv::Point2d(pose.timestamp - start, scene.view.up.dot(pose.T_wc.translation()));
  };
  Chart plan = plan_chart(scene), profile;
  plan.title = scene.title.empty() ? "From above" : scene.title + " from above";
  profile.title = "Height";
  profile.x_label = "time [s]";
  profile.y_label = "height (" + scene.view.up_name + ") [" + scene.unit + "]";
  const Trajectory truth = truth_beside(scene);
  if (!truth.empty()) {
    plan.series.push_back(
        {"ground truth", line_of(truth, above), colours::kTruth, true, kTruthWidth});
    profile.series.push_back({"", line_of(truth, height), colours::kTruth, true, kTruthWidth});
  }
  plan.series.push_back({"cairn", line_of(scene.estimate, above), colours::kEstimate});
  plan.series.back().end_markers = true;
  profile.series.push_back({"", line_of(scene.estimate, height), colours::kEstimate});
  return draw_charts({plan, profile}, {1.3, 1}, {1500, 760});
}

cv::Mat draw_map_plot(const PlotScene& scene) {
  Chart chart = plan_chart(scene);
  chart.title = scene.title.empty() ? "Map from above" : "Map of " + scene.title + " from above";
  add_planes(scene, chart);
  add_points(scene, chart);
  add_objects(scene, chart);
  ChartSeries path{"keyframes", {}, colours::kAccent};
  for (const StampedPose& pose : scene.keyframes) {
    path.points.push_back(from_above(scene.view, pose.T_wc.translation()));
  }
  path.end_markers = true;
  ChartSeries marks = path;
  marks.name.clear();
  marks.line = false;
  marks.width = 5;
  marks.end_markers = false;
  chart.series.push_back(std::move(path));
  chart.series.push_back(std::move(marks));
  return draw_charts({chart}, {1}, {1200, 900});
}

cv::Mat draw_error_plot(std::span<const double> timestamps, std::span<const double> errors,
                        const std::string& title) {
  double sum = 0;
  for (const double error : errors) sum += error * error;
  const double rms = errors.empty() ? 0 : std::sqrt(sum / double(errors.size()));
  const bool small = rms < kSmallError;
  const double units = small ? 1000 : 1;
  const std::string unit = small ? "mm" : "m";
  Chart chart;
  chart.title = title.empty() ? "Distance to the ground truth" : title + ": distance to the truth";
  chart.x_label = "time [s]";
  chart.y_label = "error [" + unit + "]";
  chart.y_min = 0;
  ChartSeries line{"error", {}, colours::kEstimate};
  Trajectory times;  // for the gaps
  for (std::size_t i = 0; i < errors.size(); ++i) {
    times.push_back({timestamps[i], SE3(Eigen::Quaterniond::Identity(), {errors[i], 0, 0})});
  }
  if (!errors.empty()) {
    line.points = line_of(times, [&](const StampedPose& pose) {
      return cv::Point2d(pose.timestamp - timestamps.front(), units * pose.T_wc.translation().x());
    });
    const double end = timestamps.back() - timestamps.front();
    chart.series.push_back({"RMSE " + fixed_text(units * rms, 2) + " " + unit,
                            {{0, units * rms}, {end, units * rms}},
                            colours::kAccent});
  }
  chart.series.push_back(std::move(line));
  return draw_charts({chart}, {1}, {1200, 560});
}

void write_png(const std::filesystem::path& file, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  if (picture.empty() || !cv::imencode(".png", picture, bytes)) {
    throw Error(Error::Kind::kOutput, file.string() + ": the picture cannot be encoded as PNG");
  }
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace cairn
