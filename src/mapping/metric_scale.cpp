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
constexpr double kErrorsLast = 0.76;  // seconds: of a picture's scale, docs/perception_noise.md
constexpr double kGate = 3;           // σ
constexpr double kOfSensor = 0.01;    // relative: the metre of a depth camera

// Robust σ around the median.
double spread_of(std::vector<WeightedValue> values) {
  const double middle = median(values);
  for (WeightedValue& v : values) v.value = std::abs(v.value - middle);
  return kSigmaOfMedian * median(std::move(values));
}

}  // namespace

ScaleEstimate given_scale(const ScaleEstimate& found, double factor) {
  return {"given", factor * found.value, 0, found.pictures, found.parts};
}

ScaleEstimate joined(const ScaleEstimate& pictures, const ScaleEstimate& sizes) {
  if (!sizes.known()) return pictures;
  if (!pictures.known()) return sizes;
  const double a = std::log(pictures.value), b = std::log(sizes.value);
  const double wa = 1 / (pictures.sigma * pictures.sigma), wb = 1 / (sizes.sigma * sizes.sigma);
  ScaleEstimate both = wa > wb ? pictures : sizes;
  if (std::abs(a - b) < kGate * std::hypot(pictures.sigma, sizes.sigma)) {
    both.how = pictures.how + " and " + sizes.how;
    both.value = std::exp((wa * a + wb * b) / (wa + wb));
    both.sigma = 1 / std::sqrt(wa + wb);
  }
  both.pictures = pictures.pictures;
  both.parts = {{pictures.how, pictures.value, pictures.sigma, pictures.pictures},
                {sizes.how, sizes.value, sizes.sigma, sizes.pictures}};
  return both;
}

MetricScale::MetricScale() : variance_(kPriorVariance), covariance_(kPriorVariance) {}

void MetricScale::add(double time, const PictureScale& picture, double sigma) {
  if (!std::isfinite(picture.scale) || !(picture.scale > 0)) return;
  const auto later = std::upper_bound(pictures_.begin(), pictures_.end(), time,
                                      [](double t, const Picture& p) { return t < p.time; });
  pictures_.insert(later, {time, picture, sigma});
  if (!(sigma > 0) || !std::isfinite(picture.variance + picture.covariance)) return;
  variance_ += picture.variance;
  covariance_ += picture.covariance;
}

// A label that is wrong in one picture does not make all of them unsure.
double MetricScale::sigma() const {
  std::vector<double> sigmas;
  sigmas.reserve(pictures_.size());
  for (const Picture& p : pictures_) sigmas.push_back(p.sigma);
  if (sigmas.empty()) return 0;
  const auto at = sigmas.begin() + static_cast<std::ptrdiff_t>((3 * sigmas.size() - 1) / 4);
  std::nth_element(sigmas.begin(), at, sigmas.end());
  return *at;
}

double MetricScale::contrast() const {
  return covariance_ > 0 ? std::clamp(variance_ / covariance_, 1.0, kMaxContrast) : kMaxContrast;
}

// Each picture is worth half of what is new on either side. (The weights of the best mean are the
// inverse of the matrix exp(-|t_i - t_k| / τ), which is tridiagonal, times ones.)
std::vector<WeightedValue> MetricScale::scales() const {
  std::vector<WeightedValue> scales;
  scales.reserve(pictures_.size());
  const double with = contrast();
  for (const Picture& p : pictures_) scales.push_back({p.scale.log_scale(with), 0});
  if (scales.empty()) return scales;
  scales.front().weight = 0.5;
  scales.back().weight += 0.5;
  for (std::size_t i = 1; i < scales.size(); ++i) {
    const double apart = pictures_[i].time - pictures_[i - 1].time;
    const double anew = std::tanh(apart / (2 * kErrorsLast));
    scales[i - 1].weight += anew / 2;
    scales[i].weight += anew / 2;
  }
  return scales;
}

double MetricScale::picture_scale() const {
  if (pictures_.empty()) return 0;
  std::vector<WeightedValue> values = scales();
  const double middle = median(values), width = kGate * spread_of(values);
  std::erase_if(values, [&](const WeightedValue& v) { return std::abs(v.value - middle) > width; });
  double sum = 0, weight = 0;
  for (const WeightedValue& v : values) {
    sum += v.weight * v.value;
    weight += v.weight;
  }
  return std::exp(sum / weight);
}

double MetricScale::spread() const {
  return pictures_.size() < kFewPictures ? kFewSpread : spread_of(scales());
}

ScaleEstimate MetricScale::estimate() const {
  if (pictures_.empty()) return {};
  const std::vector<WeightedValue> values = scales();
  double independent = 0;
  for (const WeightedValue& v : values) independent += v.weight;
  ScaleEstimate estimate;
  const double of_network = sigma();
  const bool measured = !(of_network > 0);
  estimate.how = measured ? "measured depth" : "predicted depth";
  estimate.value = 1 / picture_scale();
  estimate.sigma =
      std::hypot(measured ? kOfSensor : of_network, spread_of(values) / std::sqrt(independent));
  estimate.pictures = static_cast<int>(pictures_.size());
  return estimate;
}

}  // namespace cairn
