#include "cairn/mapping/mapper.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/features/retrieval.h"
#include "cairn/map/stopwatch.h"
#include "cairn/mapping/end_rays.h"
#include "cairn/mapping/keyframe_motion.h"
#include "cairn/mapping/missed_points.h"
#include "cairn/mapping/object_support.h"
#include "cairn/mapping/plane_confirmation.h"
#include "cairn/mapping/plane_mapping.h"
#include "cairn/mapping/point_alignment.h"
#include "cairn/mapping/point_creation.h"
#include "cairn/mapping/point_fusion.h"
#include "cairn/mapping/size_scale.h"
#include "cairn/mapping/upward.h"
#include "cairn/optimization/odometry_blocks.h"

namespace cairn {
namespace {

constexpr int kMinInitialPoints = 50;
constexpr double kMinFoundRatio = 0.25;  // of the frames that should see a point
constexpr double kUnknownScale = 0.1;    // of a picture, relative
constexpr double kLeastSpread = 0.02;    // of predicted scales
// Sigma of its logarithm: a metre that may be twice as long says nothing of the size of things.
constexpr double kTrusted = 0.7;
constexpr std::uint32_t kProbation = 3;  // keyframes
// A map of so few keyframes is adjusted with each, and learns from each how the shutter rolls.
// Later what follows within `kPause` waits for the next adjustment: it shows nearly the same. The
// readout has to do with all observations, which takes a third of the time: one adjustment in so
// many asks.
constexpr std::uint32_t kYoung = 20;
constexpr double kPause = 0.12;  // seconds
constexpr int kReadoutTurn = 8;

}  // namespace

Mapper::Mapper(const View& view, const MappingOptions& options) : options_(options), map_(view) {
  map_.set_readout(options.readout);
}

bool Mapper::initialize(const InitialPair& initial) {
  const KeyframeId first = map_.add_keyframe(initial.frame1, SE3());
  const KeyframeId second = map_.add_keyframe(initial.frame2, initial.T_21.inverse());
  for (const auto& p : initial.points) {
    const PointId id = map_.add_point(p.position);
    map_.add_observation(id, first, p.keypoint1);
    map_.add_observation(id, second, p.keypoint2);
    map_.points()[id].colour = initial.frame1->features.keypoints[p.keypoint1].colour;
    map_.update_descriptor(id);
  }
  const AdjustmentSummary summary = adjust_fully(map_, options_.adjustment, nullptr);
  const double depth = map_.depth_quantile(first, 0.5);
  if (!summary.usable || depth <= 0 || int(map_.points().size()) < kMinInitialPoints) return false;
  // One unit of the map is the median depth of its first picture, until something metric is known.
  Keyframe& k2 = map_.keyframes()[second];
  k2.T_wc = SE3(k2.T_wc.rotation(), k2.T_wc.translation() / depth);
  map_.points().for_each([&](PointId id, MapPoint& p) {
    p.position /= depth;
    map_.update_geometry(id);
  });
  map_.keyframes()[first].picture = initial.picture1;
  k2.picture = initial.picture2;
  align_points(map_, first);
  look_around(second);
  return true;
}

KeyframeId Mapper::insert(const KeyframeCandidate& candidate) {
  const Timed timed(times_.insertion);
  // The reference may have been culled since the frame was tracked.
  const Keyframe* reference = map_.keyframes().find(candidate.reference);
  const SE3 T_wr = reference != nullptr
                       ? reference->T_wc
                       : KeyframeGenealogy(map_, buried_).T_wc(candidate.reference).value();
  const KeyframeId current = map_.add_keyframe(candidate.frame, T_wr * candidate.T_rc);
  Keyframe& keyframe = map_.keyframes()[current];
  keyframe.picture = candidate.picture;
  for (std::uint32_t i = 0; i < candidate.points.size(); ++i) {
    const PointId p = candidate.points[i];
    if (!p.valid() || !map_.points().contains(p) || map_.keypoint_of(p, current) >= 0) continue;
    const bool aligned = !candidate.aligned.empty() && candidate.aligned[i] != 0;
    map_.add_observation(p, current, i, aligned ? PatchState::kFound : PatchState::kUntried);
    map_.update_descriptor(p);
    map_.update_geometry(p);
    if (map_.points()[p].assumed) measure(p);
  }
  cull_recent_points();
  const std::vector<PointId> created = create_points(
      map_, current, {options_.neighbours, options_.min_parallax_deg, options_.match_ratio});
  recent_.insert(recent_.end(), created.begin(), created.end());
  const int fused = fuse_neighbourhood(map_, current, options_.neighbours);
  align_points(map_, current);
  const int missed = find_missed_points(map_, current);
  look_back(map_);
  spdlog::debug("keyframe {} at {:.3f}: {} points, {} new, {} fused, {} missed", keyframe.sequence,
                keyframe.timestamp(), map_.tracked_points(current), created.size(), fused, missed);
  look_around(current);
  return current;
}

// A point whose depth was that of its plane is measured once two views see it apart.
void Mapper::measure(PointId id) {
  MapPoint& point = map_.points()[id];
  const auto [first, last] = end_rays(map_, point);
  point.assumed = first.dot(last) > std::cos(options_.min_parallax_deg * std::numbers::pi / 180);
}

KeyframeId Mapper::keyframe_of(const Frame& frame) const {
  KeyframeId found;
  map_.keyframes().for_each([&](KeyframeId id, const Keyframe& k) {
    if (k.timestamp() == frame.timestamp) found = id;
  });
  return found;
}

void Mapper::join(const KeyframePerception& seen) {
  const KeyframeId keyframe = keyframe_of(*seen.frame);
  if (!keyframe.valid()) return;
  times_.perception.push_back(seen.milliseconds);
  join_planes(keyframe, seen);
  join_objects(keyframe, seen);
  // The camera has gone on from the points that were assumed there.
  if (keyframe != map_.newest()) cull_recent_points();
  publish();
}

void Mapper::join_planes(KeyframeId keyframe, const KeyframePerception& seen) {
  const Timed timed(times_.planes);
  Keyframe& looked_at = map_.keyframes()[keyframe];
  looked_at.depth = seen.depth;
  looked_at.depth.resize(looked_at.points.size());  // of what was added since nothing is known
  looked_at.depth_range = seen.range;
  const PictureScale picture = align_picture(map_, keyframe, scale_.contrast());
  if (picture.usable) scale_.add(looked_at.timestamp(), picture, seen.sigma_scale);
  // A picture that cannot be compared with the map is no surer than its detector's scale.
  const double log_error =
      picture.usable ? picture.log_error : std::max(seen.sigma_scale, kUnknownScale);
  looked_at.sigma_depth = log_error;
  looked_at.sigma_depth_scale = std::max(scale_.spread(), kLeastSpread);
  const double everywhere = scale_.picture_scale();
  const double scale = picture.usable ? picture.scale : everywhere;
  if (!(scale > 0)) return;
  map_.depth_contrast = scale_.contrast();
  map_.units_a_metre = everywhere > 0 ? everywhere : scale;
  const std::vector<PointId> assumed =
      map_planes(map_, keyframe, seen, {scale, map_.units_a_metre, log_error, scale_.spread()},
                 options_.planes);
  recent_.insert(recent_.end(), assumed.begin(), assumed.end());
  spdlog::debug(
      "planes: {} in the picture at {:.3f}, {} in the map; {:.3f} units a metre, contrast {:.2f}, "
      "{} points assumed",
      seen.planes.size(), seen.frame->timestamp, map_.planes().size(), scale, map_.depth_contrast,
      assumed.size());
}

void Mapper::join_objects(KeyframeId keyframe, const KeyframePerception& seen) {
  if (seen.objects.empty() && map_.objects().empty()) return;
  const Timed timed(times_.objects);
  map_.up = find_up(map_);
  map_.units_a_metre_by_sizes.reset();
  if (scale_.sigma() > kTrusted) {
    const ScaleEstimate sizes = scale_from_sizes(map_);
    map_.units_a_metre_by_sizes = sizes.known() ? 1 / sizes.value : 0;
  }
  map_objects(map_, keyframe, seen, options_.objects, object_refusals_);
  // Where no picture has said what a metre is, things do.
  if (scale_.picture_scale() > 0) return;
  if (const ScaleEstimate sizes = scale_from_sizes(map_); sizes.known()) {
    map_.units_a_metre = 1 / sizes.value;
  }
}

void Mapper::adjust(const StopAsked& stop) {
  const Keyframe& newest = map_.keyframes()[map_.newest()];
  const bool young = newest.sequence < kYoung;
  if (!young && newest.timestamp() < last_adjusted_ + kPause) return;
  last_adjusted_ = newest.timestamp();
  const Timed timed(times_.adjustment);
  if (map_.keyframes().size() > 2) {
    AdjustmentOptions options = options_.adjustment;
    options.estimate_readout &= young || ++adjustments_ % kReadoutTurn == 0;
    const AdjustmentSummary s = adjust_locally(map_, map_.newest(), options, stop);
    spdlog::debug("local adjustment: {}; readout {:.1f} ms", s.to_string(),
                  1000 * map_.readout_estimate());
  }
  cull_keyframes();
  publish();
}

AdjustmentSummary Mapper::finish(const StopAsked& stop, std::span<const KeyframeMotion> motions) {
  if (map_.keyframes().size() < 2) return {};
  map_.keyframes().for_each([&](KeyframeId id, const Keyframe&) { find_missed_points(map_, id); });
  set_motions(map_, motions);
  remove_unconfirmed_planes(map_, options_.planes);
  settle_objects(map_, options_.objects);
  const double gap = options_.objects.max_gap;
  if (options_.objects.supports) find_supports(map_, map_.units_a_true_metre(), gap, 2 * gap);
  OdometryBlocks path(map_);  // one adjustment after the other must not lead away from it
  AdjustmentSummary summary = adjust_fully(map_, options_.adjustment, stop, &path);
  if (options_.adjustment.estimate_readout) find_motions(map_);
  // Places that were seen twice, with drift in between, meet only now.
  const int fused = fuse_everywhere(map_);
  if (fused > 0) align_points(map_, map_.newest());
  spdlog::info("full adjustment: {}; then {} points fused; readout {:.2f} ms", summary.to_string(),
               fused, 1000 * map_.readout_estimate());
  if (fused > 0) {
    AdjustmentOptions options = options_.adjustment;
    options.estimate_readout = false;  // it is known by now
    summary = adjust_fully(map_, options, stop, &path);
  }
  if (options_.refine_lens) {
    const AdjustmentSummary lens = refine_lens(map_, options_.adjustment, stop, &path);
    spdlog::info("lens {}: {}", lens.usable ? "corrected" : "left as calibrated", lens.to_string());
    if (lens.usable) summary = lens;
  }
  fuse_planes(map_, options_.planes.association);  // what the adjustments have brought together
  settle_planes(map_, options_.planes);
  settle_objects(map_, options_.objects);
  measure_scale_anew();
  // At last nothing stands on what it does not touch, by the metre of depth and sizes together.
  if (const ScaleEstimate metres = scale(); options_.objects.supports && metres.known()) {
    find_supports(map_, 1 / metres.value, gap, gap);
  }
  look_around(map_.newest());
  return summary;
}

// Of two fits before and two after fusion, and two of the lens; each is asked where it starts, too.
std::size_t Mapper::most_steps() const {
  return 6 * (static_cast<std::size_t>(options_.adjustment.full_iterations) + 1);
}

std::vector<KeyframeId> Mapper::similar_keyframes(const Features& features, int count) const {
  std::vector<KeyframeId> ids;
  std::vector<const Features*> pictures;
  map_.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    ids.push_back(id);
    pictures.push_back(&keyframe.frame->features);
  });
  std::vector<KeyframeId> result;
  for (const SimilarPicture& similar :
       rank_by_appearance(features, pictures, static_cast<std::size_t>(count))) {
    result.push_back(ids[similar.index]);
  }
  return result;
}

ScaleEstimate Mapper::scale() const { return joined(scale_.estimate(), scale_from_sizes(map_)); }

// All pictures against the points as they are now.
void Mapper::measure_scale_anew() {
  MetricScale anew;
  map_.keyframes().for_each([&](KeyframeId id, const Keyframe& keyframe) {
    const PictureScale picture = align_picture(map_, id, map_.depth_contrast);
    if (picture.usable) anew.add(keyframe.timestamp(), picture, scale_.sigma());
  });
  const double units = anew.picture_scale();
  if (!(units > 0)) return;
  scale_ = std::move(anew);
  map_.depth_contrast = scale_.contrast();
  map_.units_a_metre = units;
}

void Mapper::count_visible(std::span<const PointId> visible, std::span<const PointId> found) {
  for (const PointId id : visible) {
    if (MapPoint* p = map_.points().find(id)) ++p->visible;
  }
  for (const PointId id : found) {
    if (MapPoint* p = map_.points().find(id)) ++p->found;
  }
}

void Mapper::look_around(KeyframeId keyframe) {
  standpoint_ = keyframe;
  publish();
}

void Mapper::publish() {
  view_ = make_view(map_, standpoint_, options_.max_local_points, ++version_);
}

// New points are on probation: they must be found where they should be, and seen by a third
// keyframe once two more keyframes have had the chance.
void Mapper::cull_recent_points() {
  const std::uint32_t now = map_.keyframes()[map_.newest()].sequence;
  std::erase_if(recent_, [&](PointId id) {
    const MapPoint* p = map_.points().find(id);
    if (p == nullptr) return true;
    const std::uint32_t age = now - p->born;
    if (p->found < kMinFoundRatio * p->visible || (age >= 2 && p->observations.size() <= 2)) {
      map_.erase_point(id);
      return true;
    }
    return age >= kProbation;
  });
}

// A keyframe goes when nearly all that it sees is seen by three others as sharply as by it. Corners
// count, and not what they missed: the more often points are seen, the surer is each keyframe, but
// that is no reason to have fewer of them.
void Mapper::cull_keyframes() {
  for (const auto& [id, shared] : map_.covisible(map_.newest(), 15)) {
    if (id == map_.first() || id == standpoint_) continue;
    const Keyframe& keyframe = map_.keyframes()[id];
    int seen = 0, redundant = 0;
    for (std::uint32_t i = 0; i < keyframe.frame->corners(); ++i) {
      if (!keyframe.points[i].valid()) continue;
      ++seen;
      const int octave = keyframe.frame->octave(i);
      int others = 0;
      for (const Observation& o : map_.points()[keyframe.points[i]].observations) {
        if (o.keyframe == id) continue;
        others += map_.is_corner(o) &&
                  map_.keyframes()[o.keyframe].frame->octave(o.keypoint) <= octave + 1;
        if (others >= 3) break;
      }
      redundant += others >= 3;
    }
    if (redundant <= options_.redundancy * seen) continue;
    buried_.push_back(bury_keyframe(map_, id));
  }
}

}  // namespace cairn
