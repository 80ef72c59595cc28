#include "cairn/mapping/metric_scale.h"

#include <algorithm>
#include <cmath>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr std::size_t kFewPictures = 5;
constexpr double kFewSpread = 0.15;
constexpr double kPriorVariance =
    0.2;  // of the contrast 1: a few pictures with near and far things
constexpr double kMaxContrast = 2.5;

}  // namespace

ScaleEstimate given_scale(const ScaleEstimate& found, double factor) {
  return {"given", factor * found.value, 0, found.pictures};
}

MetricScale::MetricScale() : variance_(kPriorVariance), covariance_(kPriorVariance) {}

void MetricScale::add(const PictureScale& picture, double sigma) {
  if (!std::isfinite(picture.scale) || !(picture.scale > 0)) return;
  pictures_.push_back({std::log(picture.scale), picture.contrast, picture.predicted});
  sigma_ = std::max(sigma_, sigma);
  if (!(sigma > 0) || !std::isfinite(picture.variance + picture.covariance)) return;
  variance_ += picture.variance;
  covariance_ += picture.covariance;
}

double MetricScale::contrast() const {
  return covariance_ > 0 ? std::clamp(variance_ / covariance_, 1.0, kMaxContrast) : kMaxContrast;
}

std::vector<double> MetricScale::logs() const {
  std::vector<double> logs;
  logs.reserve(pictures_.size());
  for (const Picture& p : pictures_) {
    logs.push_back(p.log_scale - (contrast() - p.contrast) * p.predicted);
  }
  return logs;
}

double MetricScale::picture_scale() const {
  std::vector<double> values = logs();
  return values.empty() ? 0 : std::exp(median(values));
}

double MetricScale::spread() const {
  return pictures_.size() < kFewPictures ? kFewSpread : robust_spread(logs());
}

ScaleEstimate MetricScale::estimate() const {
  if (pictures_.empty()) return {};
  ScaleEstimate estimate;
  estimate.how = sigma_ > 0 ? "predicted depth" : "measured depth";
  estimate.value = 1 / picture_scale();
  estimate.sigma = std::hypot(sigma_, robust_spread(logs()) / std::sqrt(double(pictures_.size())));
  estimate.pictures = static_cast<int>(pictures_.size());
  return estimate;
}

}  // namespace cairn
