#include "cairn/mapping/metric_scale.h"

#include <algorithm>
#include <cmath>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr std::size_t kFewPictures = 5;
constexpr double kFewSpread = 0.15;

}  // namespace

ScaleEstimate given_scale(const ScaleEstimate& found, double factor) {
  return {"given", factor * found.value, 0, found.pictures};
}

void MetricScale::add(double picture_scale, double sigma) {
  if (!std::isfinite(picture_scale) || !(picture_scale > 0)) return;
  logs_.push_back(-std::log(picture_scale));
  sigma_ = std::max(sigma_, sigma);
}

double MetricScale::picture_scale() const {
  std::vector<double> logs = logs_;  // in order of time, which median changes
  return logs.empty() ? 0 : std::exp(-median(logs));
}

double MetricScale::spread() const {
  return logs_.size() < kFewPictures ? kFewSpread : robust_spread(logs_);
}

ScaleEstimate MetricScale::estimate() const {
  if (logs_.empty()) return {};
  ScaleEstimate estimate;
  estimate.how = sigma_ > 0 ? "predicted depth" : "measured depth";
  estimate.value = 1 / picture_scale();
  estimate.sigma = std::hypot(sigma_, robust_spread(logs_) / std::sqrt(double(logs_.size())));
  estimate.pictures = static_cast<int>(logs_.size());
  return estimate;
}

}  // namespace cairn
