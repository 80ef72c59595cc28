#include "cairn/mapping/metric_scale.h"

#include <algorithm>
#include <cmath>

#include "cairn/geometry/median.h"

namespace cairn {
void MetricScale::add(double picture_scale, double sigma) {
  if (!std::isfinite(picture_scale) || !(picture_scale > 0)) return;
  logs_.push_back(-std::log(picture_scale));
  sigma_ = std::max(sigma_, sigma);
}

double MetricScale::picture_scale() const {
  std::vector<double> logs = logs_;  // in order of time, which median changes
  return logs.empty() ? 0 : std::exp(-median(logs));
}

ScaleEstimate MetricScale::estimate() const {
  if (logs_.empty()) return {};
  std::vector<double> logs = logs_;
  const double middle = median(logs);
  std::vector<double> deviations;
  deviations.reserve(logs_.size());
  for (const double value : logs_) deviations.push_back(std::abs(value - middle));
  const double spread = 1.4826 * median(deviations);
  ScaleEstimate estimate;
  estimate.how = sigma_ > 0 ? "predicted depth" : "measured depth";
  estimate.value = std::exp(middle);
  estimate.sigma = std::hypot(sigma_, spread / std::sqrt(double(logs_.size())));
  estimate.pictures = static_cast<int>(logs_.size());
  return estimate;
}

}  // namespace cairn
