#include "cairn/map/map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr double kInstant = 0.004;     // seconds: shutters that take less may as well not roll
constexpr double kReadoutStep = 2e-4;  // seconds: less moves keypoints by hundredths of a pixel
constexpr double kFar = 1e9;

}  // namespace

KeyframeId Map::add_keyframe(std::shared_ptr<const Frame> frame, const SE3& T_wc) {
  Keyframe keyframe;
  keyframe.sequence = next_sequence_++;
  keyframe.T_wc = T_wc;
  keyframe.points.resize(frame->size());
  keyframe.frame = std::move(frame);
  newest_ = keyframes_.insert(std::move(keyframe));
  if (!first_.valid()) first_ = newest_;
  return newest_;
}

std::vector<double> Map::depths(KeyframeId id) const {
  const Keyframe& keyframe = keyframes_[id];
  const double most = depth_quantile(id, 0.5);
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::vector<double> depths(keyframe.points.size(), most > 0 ? most : kFar);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    const double z = (T_cw * points_[keyframe.points[i]].position).z();
    if (z > 0) depths[i] = z;
  }
  return depths;
}

const Observation* MapPoint::seen_from(KeyframeId keyframe) const {
  const auto it = std::find_if(observations.begin(), observations.end(),
                               [&](const Observation& o) { return o.keyframe == keyframe; });
  return it != observations.end() ? &*it : nullptr;
}

Observation* MapPoint::seen_from(KeyframeId keyframe) {
  return const_cast<Observation*>(std::as_const(*this).seen_from(keyframe));
}

void Map::set_readout(double estimate) {
  readout_estimate_ = estimate;
  readout_ = std::abs(estimate) < kInstant ? 0 : estimate;
  keyframes_.for_each([&](KeyframeId id, const Keyframe& keyframe) {
    const Frame& frame = *keyframe.frame;
    if (frame.rolls() && std::abs(readout_ - frame.readout) >= kReadoutStep) {
      set_velocity(id, frame.velocity);
    }
  });
}

void Map::set_velocity(KeyframeId id, const Vector6d& velocity) {
  Keyframe& keyframe = keyframes_[id];
  auto moved = std::make_shared<Frame>(*keyframe.frame);  // a tracker may look at it
  unroll(*moved, view_.pinhole(), depths(id), readout_, velocity);
  keyframe.frame = std::move(moved);
}

// Stretched from m, the logarithms' mean becomes μ' = m + c (μ − m) and their variance c² v. The
// mean of such depths, as far as their logarithms are normal, is exp(μ' + c² v / 2): it stays where
// it is stretched from, exp(m), if m = μ + c v / 2.
double log_stretch(double from_mean, const DepthRange& range, double contrast) {
  return (contrast - 1) * (from_mean - contrast * range.variance / 2);
}

double stretched_depth(double depth, const DepthRange& range, double contrast) {
  if (!range.known() || !(depth > 0)) return depth;
  return depth * std::exp(log_stretch(std::log(depth) - range.mean, range, contrast));
}

void Map::erase_keyframe(KeyframeId id) {
  if (!planes_.empty() || !objects_.empty()) {
    const auto neighbours = covisible(id, 1, 1);
    const KeyframeId heir = neighbours.empty() ? KeyframeId{} : neighbours.front().first;
    move_planes(id, heir);
    move_objects(id, heir);
  }
  const std::vector<PointId> seen = keyframes_[id].points;
  for (const PointId point : seen) {
    if (point.valid()) erase_observation(point, id);
  }
  keyframes_.erase(id);
}

PointId Map::add_point(const Eigen::Vector3d& position) {
  MapPoint point;
  point.position = position;
  if (newest_.valid()) point.born = keyframes_[newest_].sequence;
  return points_.insert(std::move(point));
}

void Map::erase_point(PointId id) {
  set_plane_of(id, {});
  const std::vector<Observation>& observations = points_[id].observations;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    keyframes_[o.keyframe].points[o.keypoint] = {};
    for (std::size_t k = 0; k < i; ++k) {
      covisibility_.count(o.keyframe, observations[k].keyframe, -1);
    }
  }
  points_.erase(id);
}

void Map::add_observation(PointId point, KeyframeId keyframe, std::uint32_t keypoint,
                          PatchState patch) {
  assert(!keyframes_[keyframe].points[keypoint].valid());
  assert(keypoint_of(point, keyframe) < 0);
  keyframes_[keyframe].points[keypoint] = point;
  std::vector<Observation>& observations = points_[point].observations;
  for (const Observation& o : observations) covisibility_.count(keyframe, o.keyframe, 1);
  // Doubling, as push_back does, would waste too much over thousands of points.
  if (observations.size() == observations.capacity()) observations.reserve(observations.size() + 2);
  observations.push_back({keyframe, keypoint, patch});
}

void Map::erase_observation(PointId id, KeyframeId keyframe) {
  std::vector<Observation>& observations = points_[id].observations;
  const Observation* const observation = points_[id].seen_from(keyframe);
  assert(observation != nullptr);
  keyframes_[keyframe].points[observation->keypoint] = {};
  observations.erase(observations.begin() + (observation - observations.data()));
  for (const Observation& o : observations) covisibility_.count(keyframe, o.keyframe, -1);
  if (observations.size() < 2) erase_point(id);
}

void Map::merge_points(PointId from, PointId into) {
  assert(from != into);
  const std::vector<Observation> moved = points_[from].observations;
  MapPoint& target = points_[into];
  target.visible += points_[from].visible;
  target.found += points_[from].found;
  if (!target.plane.valid()) set_plane_of(into, points_[from].plane);
  if (target.assumed && !points_[from].assumed) {
    target.position = points_[from].position;
    target.assumed = false;
  }
  erase_point(from);
  for (const Observation& o : moved) {
    if (keypoint_of(into, o.keyframe) < 0) add_observation(into, o.keyframe, o.keypoint);
  }
  update_descriptor(into);
  update_geometry(into);
}

double Map::viewing_distance(PointId id) const {
  const MapPoint& point = points_[id];
  const Keyframe& eye = keyframes_[point.observations.front().keyframe];
  return (point.position - eye.T_wc.translation()).norm();
}

std::vector<Eigen::Vector3d> Map::measured_points_at(
    const Keyframe& keyframe, const std::vector<std::uint32_t>& keypoints) const {
  const SE3 T_kw = keyframe.T_wc.inverse();
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t i : keypoints) {
    const MapPoint* point = points_.find(keyframe.points[i]);
    if (point != nullptr && !point->assumed) points.push_back(T_kw * point->position);
  }
  return points;
}

Eigen::Vector2d Map::reprojection_error(KeyframeId keyframe, std::uint32_t keypoint,
                                        const Eigen::Vector3d& position) const {
  const Keyframe& seeing = keyframes_[keyframe];
  const Eigen::Vector3d X = seeing.T_wc.inverse() * position;
  if (X.z() <= 0) return Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  return lens_.project(view_.pinhole(), X) - seeing.frame->pixel(keypoint);
}

int Map::keypoint_of(PointId point, KeyframeId keyframe) const {
  const Observation* const observation = points_[point].seen_from(keyframe);
  return observation != nullptr ? static_cast<int>(observation->keypoint) : -1;
}

void Map::update_geometry(PointId id) {
  MapPoint& point = points_[id];
  if (point.observations.empty()) return;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double log_base = 0;
  for (const Observation& o : point.observations) {
    const Keyframe& keyframe = keyframes_[o.keyframe];
    const Eigen::Vector3d ray = point.position - keyframe.T_wc.translation();
    const double distance = std::max(ray.norm(), 1e-12);
    normal += ray / distance;
    log_base += std::log(distance * view_.scale(keyframe.frame->octave(o.keypoint)));
  }
  point.normal = normal.normalized().cast<float>();
  point.base_distance = static_cast<float>(std::exp(log_base / point.observations.size()));
}

void Map::update_descriptor(PointId id) {
  MapPoint& point = points_[id];
  // The last dozen observations are enough to find a typical one, and bound the cost.
  constexpr std::size_t kConsidered = 12;
  std::array<const Descriptor*, kConsidered> descriptors{};
  std::size_t n = 0;
  for (std::size_t i = point.observations.size(); i > 0 && n < kConsidered; --i) {
    const Observation& o = point.observations[i - 1];
    if (!is_corner(o)) continue;  // what was added has no descriptor of its own
    descriptors[n++] = &keyframes_[o.keyframe].frame->features.descriptors[o.keypoint];
  }
  int best_median = 257;
  for (std::size_t i = 0; i < n; ++i) {
    std::array<int, kConsidered> distances{};
    for (std::size_t j = 0; j < n; ++j) distances[j] = hamming(*descriptors[i], *descriptors[j]);
    std::nth_element(distances.begin(), distances.begin() + n / 2, distances.begin() + n);
    if (distances[n / 2] < best_median) {
      best_median = distances[n / 2];
      point.descriptor = *descriptors[i];
    }
  }
}

std::vector<std::pair<KeyframeId, int>> Map::covisible(KeyframeId id, int min_shared,
                                                       std::size_t most) const {
  std::vector<std::pair<KeyframeId, int>> result;
  for (const auto& entry : covisibility_.of(id)) {
    if (entry.second >= min_shared) result.push_back(entry);
  }
  std::sort(result.begin(), result.end(), [&](const auto& a, const auto& b) {
    if (a.second != b.second) return a.second > b.second;
    return keyframes_[a.first].sequence < keyframes_[b.first].sequence;
  });
  if (result.size() > most) result.resize(most);
  return result;
}

double Map::depth_quantile(KeyframeId id, double rank) const {
  const Keyframe& keyframe = keyframes_[id];
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::vector<double> depths;
  for (const PointId p : keyframe.points) {
    if (p.valid()) depths.push_back((T_cw * points_[p].position).z());
  }
  return depths.empty() ? 0 : quantile(depths, rank);
}

int Map::tracked_points(KeyframeId id) const {
  const Keyframe& keyframe = keyframes_[id];
  const auto corners = std::span(keyframe.points).first(keyframe.frame->corners());
  return int(std::count_if(corners.begin(), corners.end(), [](PointId p) { return p.valid(); }));
}

}  // namespace cairn
