#include "cairn/tracking/relocalizer.h"

#include <algorithm>

#include "cairn/geometry/resection.h"

namespace cairn {
namespace {

constexpr int kMinMatches = 15;
constexpr int kMinResectionInliers = 10;

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
    const SE3 T_cw = T_wc_.inverse();
    std::vector<char> taken(map_->points.size(), 0);
    for (const std::uint32_t p : points_) {
      if (p != kNoPoint) taken[p] = 1;
    }
    std::vector<ExpectedPoint> expected;
    for (std::uint32_t i = 0; i < map_->points.size(); ++i) {
      const MapView::Point& p = map_->points[i];
      if (taken[i]) continue;
      const Visibility v = predict_visibility(view_, T_cw, T_wc_.translation(), p.position,
                                              p.normal, p.base_distance);
      if (!v.visible) continue;
      expected.push_back({i, v.pixel.cast<float>(),
                          static_cast<float>(radius * view_.scale(v.octave)),
                          static_cast<std::int16_t>(v.octave - 1),
                          static_cast<std::int16_t>(v.octave + 1), &p.descriptor});
    }
    search_by_projection(frame_, expected, {80, 0.85}, points_);
    return adjust();
  }

  Relocalization result(int inliers) const {
    Relocalization r{map_, T_wc_, {}, inliers};
    for (const std::uint32_t p : points_) {
      r.points.push_back(p == kNoPoint ? PointId{} : map_->points[p].id);
    }
    return r;
  }

 private:
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

}  // namespace

std::optional<Relocalization> relocalize(const Frame& frame, const Map& map,
                                         std::span<const KeyframeId> candidates,
                                         const TrackingOptions& options, std::uint64_t seed) {
  for (const KeyframeId id : candidates) {
    if (!map.keyframes().contains(id)) continue;
    Attempt attempt(frame, map, id, options);
    if (!attempt.match_by_appearance() || !attempt.resect(seed)) continue;
    if (attempt.search_map(10) < kMinMatches) continue;
    const int inliers = attempt.search_map(4);
    if (inliers >= options.min_inliers) return attempt.result(inliers);
  }
  return std::nullopt;
}

}  // namespace cairn
