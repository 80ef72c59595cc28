#include "cairn/tracking/relocalizer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <span>

#include "cairn/geometry/resection.h"
#include "cairn/tracking/object_relocalization.h"

namespace cairn {
namespace {

constexpr int kMinMatches = 15;
constexpr int kMinResectionInliers = 10;
// Of the share of the points in sight that a keyframe sees itself. Where patterns repeat
// (wallpaper), a wrong pose finds many points, but only a few of all.
constexpr double kLeastShare = 1.0 / 3;
constexpr std::size_t kViews = 3;  // keyframes whose surroundings are searched around a pose
// Pixels at octave 0. A pose by objects puts what is near them to within their boxes' errors.
constexpr double kObjectRadius = 20;

// One candidate keyframe, from descriptors to a pose that the local map confirms.
class Attempt {
 public:
  Attempt(const Frame& frame, const Map& map, KeyframeId candidate, const TrackingOptions& options)
      : frame_(frame),
        view_(map.view()),
        map_(make_view(map, candidate, options.max_local_points, 0)) {
    points_.assign(frame.size(), kNoPoint);
  }

  bool match_by_appearance() {
    int count = 0;
    MatchOptions match_options;
    for (const auto& m :
         match_mutual(map_->reference_frame->features, frame_.features, match_options)) {
      const std::uint32_t point = map_->reference_points[m.first];
      if (point == kNoPoint) continue;
      points_[m.second] = point;
      ++count;
    }
    return count >= kMinMatches;
  }

  bool match_around(const SE3& T_wc, double radius) {
    T_wc_ = T_wc;
    search(radius);
    const auto none = std::count(points_.begin(), points_.end(), kNoPoint);
    return static_cast<int>(points_.size() - none) >= kMinMatches;
  }

  bool resect(std::uint64_t seed) {
    gather();
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector2d> pixels;
    std::vector<double> sigmas;
    for (const PoseObservation& o : observations_) {
      positions.push_back(o.position);
      pixels.push_back(o.pixel);
      sigmas.push_back(o.sigma);
    }
    ResectionOptions options;
    options.min_inliers = kMinResectionInliers;
    const ResectionResult result =
        cairn::resect({positions, pixels, sigmas}, view_.pinhole(), options, seed);
    if (!result.usable) return false;
    T_wc_ = result.T_cw.inverse();
    return adjust() >= kMinResectionInliers;
  }

  int search_map(double radius) {
    search(radius);
    return adjust();
  }

  // The inliers; 0: points do not confirm the pose so far.
  int confirm(const TrackingOptions& options) {
    if (search_map(10) < kMinMatches) return 0;
    const int inliers = search_map(4);
    const double share = inliers / count_visible(T_wc_) / usual_share();
    spdlog::debug("relocalisation: {} points agree, {:.2f} of what is usual here", inliers, share);
    return inliers >= options.min_inliers && share >= kLeastShare ? inliers : 0;
  }

  Relocalization result(int inliers) const {
    Relocalization r{map_, T_wc_, {}, inliers};
    for (const std::uint32_t p : points_) {
      r.points.push_back(p == kNoPoint ? PointId{} : map_->points[p].id);
    }
    return r;
  }

 private:
  Visibility see(const SE3& T_wc, const SE3& T_cw, const MapView::Point& p) const {
    return predict_visibility(view_, T_cw, T_wc.translation(), p.position, p.normal,
                              p.base_distance);
  }

  void search(double radius) {
    const SE3 T_cw = T_wc_.inverse();
    std::vector<char> taken(map_->points.size(), 0);
    for (const std::uint32_t p : points_) {
      if (p != kNoPoint) taken[p] = 1;
    }
    std::vector<ExpectedPoint> expected;
    for (std::uint32_t i = 0; i < map_->points.size(); ++i) {
      const MapView::Point& p = map_->points[i];
      if (taken[i]) continue;
      const Visibility v = see(T_wc_, T_cw, p);
      if (!v.visible) continue;
      expected.push_back({i, v.pixel.cast<float>(),
                          static_cast<float>(radius * view_.scale(v.octave)),
                          static_cast<std::int16_t>(v.octave - 1),
                          static_cast<std::int16_t>(v.octave + 1), &p.descriptor});
    }
    search_by_projection(frame_, expected, {80, 0.85}, points_);
  }

  // Points of the map that a pose should show.
  double count_visible(const SE3& T_wc) const {
    const SE3 T_cw = T_wc.inverse();
    const auto count =
        std::count_if(map_->points.begin(), map_->points.end(),
                      [&](const MapView::Point& p) { return see(T_wc, T_cw, p).visible; });
    return std::max(1.0, static_cast<double>(count));
  }

  // Of the points that the candidate's pose should show, those that it shows.
  double usual_share() const {
    return std::max(1, map_->reference_tracked) /
           count_visible(map_->pose_of(map_->reference).value());
  }

  void gather() {
    observations_.clear();
    keypoints_.clear();
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (points_[i] == kNoPoint) continue;
      observations_.push_back(
          {map_->points[points_[i]].position, frame_.pixel(i), view_.sigma(frame_.octave(i))});
      keypoints_.push_back(i);
    }
  }

  int adjust() {
    gather();
    const PoseAdjustmentSummary s = adjust_pose(observations_, view_.pinhole(), T_wc_, inlier_);
    for (std::size_t k = 0; k < keypoints_.size(); ++k) {
      if (!inlier_[k]) points_[keypoints_[k]] = kNoPoint;
    }
    return s.usable ? s.inliers : 0;
  }

  const Frame& frame_;
  const View& view_;
  std::shared_ptr<const MapView> map_;
  SE3 T_wc_;
  std::vector<std::uint32_t> points_;
  std::vector<PoseObservation> observations_;
  std::vector<std::uint32_t> keypoints_;
  std::vector<char> inlier_;
};

// Those that see most of the points that a camera at this pose should see; the nearest where there
// are none. Ids decide between equals.
std::vector<KeyframeId> keyframes_around(const Map& map, const SE3& T_wc) {
  const SE3 T_cw = T_wc.inverse();
  std::map<KeyframeId, int> shared;
  map.points().for_each([&](PointId, const MapPoint& p) {
    const Visibility v = predict_visibility(map.view(), T_cw, T_wc.translation(), p.position,
                                            p.normal, p.base_distance);
    if (!v.visible) return;
    for (const Observation& o : p.observations) ++shared[o.keyframe];
  });
  std::vector<std::pair<double, KeyframeId>> ranked;  // the less the better
  ranked.reserve(shared.size());
  for (const auto& [id, count] : shared) ranked.emplace_back(-count, id);
  if (ranked.empty()) {
    map.keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
      ranked.emplace_back((k.T_wc.translation() - T_wc.translation()).norm(), id);
    });
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<KeyframeId> ids;
  for (std::size_t i = 0; i < std::min(kViews, ranked.size()); ++i) {
    ids.push_back(ranked[i].second);
  }
  return ids;
}

}  // namespace

std::optional<Relocalization> relocalize(const Frame& frame, const Map& map,
                                         std::span<const KeyframeId> candidates,
                                         const TrackingOptions& options, std::uint64_t seed) {
  std::optional<Relocalization> best;
  for (const KeyframeId id : candidates) {
    if (!map.keyframes().contains(id)) continue;
    Attempt attempt(frame, map, id, options);
    if (!attempt.match_by_appearance() || !attempt.resect(seed)) continue;
    const int inliers = attempt.confirm(options);
    if (inliers > (best ? best->inliers : 0)) best = attempt.result(inliers);
  }
  return best;
}

std::optional<Relocalization> relocalize_with_objects(const Frame& frame, const Map& map,
                                                      std::span<const SeenObject> seen,
                                                      const TrackingOptions& options,
                                                      std::uint64_t seed) {
  std::vector<KnownObject> known;
  map.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    if (landmark.born) known.push_back({map.object_in_world(id), landmark.class_name()});
  });
  const auto by_objects = relocalize_by_objects(seen, known, map.view());
  if (!by_objects) return std::nullopt;
  const SE3 T_wc = by_objects->T_cw.inverse();
  const std::vector<KeyframeId> around = keyframes_around(map, T_wc);
  for (const KeyframeId id : around) {
    Attempt attempt(frame, map, id, options);
    if (!attempt.match_around(T_wc, kObjectRadius) || !attempt.resect(seed)) continue;
    const int inliers = attempt.confirm(options);
    if (inliers == 0) continue;
    Relocalization result = attempt.result(inliers);
    result.objects = by_objects->agreeing;
    return result;
  }
  if (!by_objects->certain || around.empty()) return std::nullopt;
  return Relocalization{make_view(map, around.front(), options.max_local_points, 0), T_wc,
                        std::vector<PointId>(frame.size()), 0, by_objects->agreeing};
}

}  // namespace cairn
