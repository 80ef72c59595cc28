#include "cairn/mapping/metric_scale.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

double median(std::vector<double> values) {
  const auto mid = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), mid, values.end());
  return *mid;
}

}  // namespace

void MetricScale::add(double picture_scale, double sigma) {
  if (!std::isfinite(picture_scale) || !(picture_scale > 0)) return;
  logs_.push_back(-std::log(picture_scale));
  sigma_ = std::max(sigma_, sigma);
}

double MetricScale::picture_scale() const { return logs_.empty() ? 0 : std::exp(-median(logs_)); }

ScaleEstimate MetricScale::estimate() const {
  if (logs_.empty()) return {};
  const double middle = median(logs_);
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
