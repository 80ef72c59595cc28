#include "cairn/synthetic/shapes/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairn {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

template <typename Point>
std::vector<Point> catmull_rom(std::span<const Point> points, int steps) {
  const auto at = [&](int i) { return points[std::clamp(i, 0, int(points.size()) - 1)]; };
  std::vector<Point> curve;
  for (int i = 0; i + 1 < int(points.size()); ++i) {
    const Point a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    for (int k = 0; k < steps; ++k) {
      const float t = float(k) / float(steps);
      const Point p1 = (c - a) * 0.5f, p2 = a - 2.5f * b + 2.0f * c - 0.5f * d;
      const Point p3 = 1.5f * (b - c) + 0.5f * (d - a);
      curve.push_back(b + t * (p1 + t * (p2 + t * p3)));
    }
  }
  curve.push_back(points.back());
  return curve;
}

}  // namespace

Outline circle(float radius, int points) { return ellipse(radius, radius, points); }

Outline ellipse(float a, float b, int points) {
  Outline outline;
  for (int i = 0; i < points; ++i) {
    const float angle = 2 * kPi * float(i) / float(points);
    outline.emplace_back(a * std::cos(angle), b * std::sin(angle));
  }
  return outline;
}

Outline rounded_rectangle(float size_x, float size_y, float radius, int steps) {
  const float x = size_x / 2 - radius, y = size_y / 2 - radius;
  const Eigen::Vector2f corners[] = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
  Outline outline;
  for (int c = 0; c < 4; ++c) {
    for (int k = 0; k <= steps; ++k) {
      const float angle = kPi / 2 * (float(c) + float(k) / float(steps));
      outline.push_back(corners[c] + radius * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
    }
  }
  return outline;
}

Outline inset(const Outline& outline, float distance) {
  Outline moved;
  const int n = int(outline.size());
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2f in = (outline[i] - outline[(i + n - 1) % n]).normalized();
    const Eigen::Vector2f out = (outline[(i + 1) % n] - outline[i]).normalized();
    const Eigen::Vector2f n_in(-in.y(), in.x()), n_out(-out.y(), out.x());
    // The mitre: on both moved edges at once.
    const float bend = std::max(0.2f, 1 + n_in.dot(n_out));
    moved.push_back(outline[i] + distance * (n_in + n_out) / bend);
  }
  return moved;
}

Path smooth(const Path& points, int steps) { return catmull_rom<Eigen::Vector3f>(points, steps); }

std::vector<Eigen::Vector2f> smooth(std::span<const Eigen::Vector2f> points, int steps) {
  return catmull_rom<Eigen::Vector2f>(points, steps);
}

Path round_corners(const Path& points, float radius, int steps) {
  Path path{points.front()};
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Eigen::Vector3f back = points[i - 1] - points[i], ahead = points[i + 1] - points[i];
    const float reach = std::min({radius, 0.45f * back.norm(), 0.45f * ahead.norm()});
    const Eigen::Vector3f from = points[i] + reach * back.normalized();
    const Eigen::Vector3f to = points[i] + reach * ahead.normalized();
    for (int k = 0; k <= steps; ++k) {  // a quadratic Bezier curve
      const float t = float(k) / float(steps);
      path.push_back((1 - t) * (1 - t) * from + 2 * t * (1 - t) * points[i] + t * t * to);
    }
  }
  path.push_back(points.back());
  return path;
}

std::vector<float> evenly(float from, float to, int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i)
    values.push_back(from + (to - from) * float(i) / float(std::max(1, count - 1)));
  return values;
}

}  // namespace cairn
