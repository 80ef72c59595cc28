#include "cairn/map/object_landmark.h"

#include <algorithm>

namespace cairn {

bool ObjectLandmark::seen_by(KeyframeId keyframe) const {
  return std::any_of(observations.begin(), observations.end(), [&](const ObjectObservation& o) {
    return o.keyframe == keyframe && !o.buried;
  });
}

const std::string& ObjectLandmark::class_name() const {
  static const std::string kNone;
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? kNone : most->first;
}

double ObjectLandmark::score() const {
  double sum = 0;
  for (const ObjectObservation& o : observations) sum += o.score;
  return observations.empty() ? 0 : sum / double(observations.size());
}

}  // namespace cairn
