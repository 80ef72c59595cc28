#include "cairn/map/object_landmark.h"

#include <algorithm>

namespace cairn {

bool ObjectLandmark::seen_by(KeyframeId keyframe) const {
  return std::any_of(observations.begin(), observations.end(), [&](const ObjectObservation& o) {
    return o.keyframe == keyframe && !o.buried;
  });
}

void ObjectLandmark::take_sightings(const ObjectLandmark& other) {
  for (const auto& [name, score] : other.votes) votes[name] += score;
  for (const auto& [thing, times] : other.things) things[thing] += times;
  last_seen = std::max(last_seen, other.last_seen);
  last_time = std::max(last_time, other.last_time);
  for (const ObjectObservation& o : other.observations) {
    const auto same = [&](const ObjectObservation& own) { return own.time == o.time; };
    if (std::none_of(observations.begin(), observations.end(), same)) {
      observations.push_back(o);
      ++sightings;
    }
  }
  sightings = std::max(sightings, other.sightings);  // both may have forgotten some
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
