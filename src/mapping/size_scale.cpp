#include "cairn/mapping/size_scale.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cairn/map/object_classes.h"

namespace cairn {
namespace {

// Of the class's ellipsoid, that fits have in the median: most boxes show a thing from the level,
// or from its ends. (Things of synthetic desks and streets 0.95, cars of KITTI 00 0.85.)
constexpr double kFitted = 0.92;
constexpr double kFitSigma = 0.15;  // of the logarithm of a fitted size: boxes are rough
constexpr double kShared = 0.1;     // of the logarithm, for all things of a map together
constexpr double kWidth = 2;        // σ: Huber
constexpr int kRounds = 10;

struct Said {
  double log_scale, sigma;
};

}  // namespace

ScaleEstimate scale_from_sizes(const Map& map) {
  std::vector<Said> said;
  map.objects().for_each([&](ObjectId, const ObjectLandmark& landmark) {
    if (!landmark.born) return;
    const ObjectClass* c = find_object_class(landmark.class_name());
    if (c == nullptr) return;
    const double size = std::cbrt(landmark.ellipsoid.semi_axes.prod());
    if (!(size > 0) || !std::isfinite(size)) return;
    said.push_back({std::log(kFitted * usual_size(*c) / size), std::hypot(c->sigma, kFitSigma)});
  });
  if (said.empty()) return {};
  std::vector<WeightedValue> values;
  values.reserve(said.size());
  for (const Said& s : said) values.push_back({s.log_scale, 1 / s.sigma});
  double mean = median(values), information = 0;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0;
    information = 0;
    for (const Said& s : said) {
      const double off = std::abs(s.log_scale - mean) / s.sigma;
      const double weight = (off < kWidth ? 1 : kWidth / off) / (s.sigma * s.sigma);
      sum += weight * s.log_scale;
      information += weight;
    }
    mean = sum / information;
  }
  ScaleEstimate estimate;
  estimate.how = "object sizes";
  estimate.value = std::exp(mean);
  estimate.sigma = std::hypot(kShared, 1 / std::sqrt(information));
  estimate.pictures = static_cast<int>(said.size());
  return estimate;
}

}  // namespace cairn
