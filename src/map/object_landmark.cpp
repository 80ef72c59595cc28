#include "cairn/map/object_landmark.h"

#include <algorithm>
#include <iterator>

namespace cairn {

bool ObjectLandmark::seen_by(KeyframeId keyframe) const {
  return std::any_of(observations.begin(), observations.end(), [&](const ObjectObservation& o) {
    return o.keyframe == keyframe && !o.buried;
  });
}

void ObjectLandmark::observe(const ObjectObservation& seen) {
  const auto later = [](const ObjectObservation& a, const ObjectObservation& b) {
    return a.time < b.time;
  };
  observations.insert(std::upper_bound(observations.begin(), observations.end(), seen, later),
                      seen);
  if (observations.size() <= kMostObservations) return;
  std::size_t least = 1;  // the oldest and the newest stay
  const auto gap = [&](std::size_t i) {
    return observations[i + 1].time - observations[i - 1].time;
  };
  for (std::size_t i = 2; i + 1 < observations.size(); ++i) {
    if (gap(i) < gap(least)) least = i;
  }
  observations.erase(observations.begin() + static_cast<std::ptrdiff_t>(least));
}

void ObjectLandmark::take_sightings(const ObjectLandmark& other) {
  for (const auto& [name, score] : other.votes) votes[name] += score;
  for (const auto& [thing, times] : other.things) things[thing] += times;
  last_seen = std::max(last_seen, other.last_seen);
  last_time = std::max(last_time, other.last_time);
  std::vector<ObjectObservation> fresh;
  std::copy_if(other.observations.begin(), other.observations.end(), std::back_inserter(fresh),
               [&](const ObjectObservation& o) {
                 return std::none_of(
                     observations.begin(), observations.end(),
                     [&](const ObjectObservation& own) { return own.time == o.time; });
               });
  for (const ObjectObservation& o : fresh) observe(o);
  // Both may have forgotten some.
  sightings = std::max(sightings + std::uint32_t(fresh.size()), other.sightings);
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
