#include "cairn/synthetic/scenes/route.h"

#include <algorithm>
#include <cmath>

namespace cairn {

using Eigen::Vector2d;

Route::Route(std::vector<Vector2d> corners, double radius, const Speed& speed) : radius_(radius) {
  points_.push_back(corners.front());
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vector2d in = (corners[i] - corners[i - 1]).normalized();
    const Vector2d out = (corners[i + 1] - corners[i]).normalized();
    // A quarter of a circle, or whatever the corner asks for, as a quadratic curve.
    constexpr int kPieces = 24;
    for (int k = 0; k <= kPieces; ++k) {
      const double a = double(k) / kPieces;
      points_.push_back((1 - a) * (1 - a) * (corners[i] - radius * in) +
                        2 * a * (1 - a) * corners[i] + a * a * (corners[i] + radius * out));
    }
  }
  points_.push_back(corners.back());
  lengths_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) turns_.push_back(lengths_[i * 25 - 12]);
  for (double s = 0; s < lengths_.back();) {
    reached_.push_back(s);
    const double near = std::exp(-std::pow(corner_distance(s) / (1.6 * radius), 2));
    s += 0.01 * (speed.straight + (speed.corner - speed.straight) * near);
  }
}

double Route::corner_distance(double s) const {
  double nearest = 1e9;
  for (const double turn : turns_) nearest = std::min(nearest, std::abs(s - turn));
  return nearest;
}

Vector2d Route::on_line(double s) const {
  const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, s);
  const auto i = std::size_t(after - lengths_.begin());
  const double a = (s - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
  return points_[i - 1] + a * (points_[i] - points_[i - 1]);
}

Vector2d Route::at(double t) const {
  const double place = std::clamp(t * 100, 0.0, double(reached_.size()) - 1.001);
  const auto i = std::size_t(place);
  const double a = t * 100 - double(i);
  const double s = reached_[i] + a * (reached_[i + 1] - reached_[i]);
  // The mean over a stretch of the way: no kinks.
  Vector2d sum = Vector2d::Zero();
  constexpr int kSteps = 8;
  for (int k = -kSteps; k <= kSteps; ++k) sum += on_line(s + 0.25 * radius_ * k / kSteps);
  return sum / (2 * kSteps + 1);
}

double Route::heading(double t) const {
  const Vector2d step = at(t + 0.15) - at(t - 0.15);
  return std::atan2(step.y(), step.x());
}

}  // namespace cairn
