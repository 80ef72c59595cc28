#include "cairn/tracking/tracker.h"

#include <algorithm>

#include "cairn/map/independent_pictures.h"
#include "cairn/map/stopwatch.h"

namespace cairn {
namespace {

constexpr int kMinMatches = 20;      // of the motion model, before a wider search
constexpr int kCautiousFrames = 3;   // after a (re)start, search wider
constexpr double kUnsureTilt = 0.3;  // radians: such a plane of the map holds nothing
// Weights say how little a picture knows; a wall that is far off is still that wall.
constexpr PlaneAssociationOptions kLoose = {.max_angle_deg = 45, .max_offset = 0.6};
// What hands and vehicles do to a camera between two frames. Where points cannot tell a turn from a
// shift it is a turn: hands turn a camera within a frame, but do not throw it.
constexpr double kAcceleration = 3;       // median depths a second squared
constexpr double kTurnAcceleration = 30;  // radians a second squared
constexpr double kLeastStep = 1e-3;       // seconds between frames
constexpr double kLeastDepth = 1e-3;      // of a scene
constexpr double kFrontalCosine = 0.998;
constexpr int kMostWaiting = 3;        // keyframes
constexpr int kFewestOfKeyframe = 15;  // points
constexpr double kWeakShare = 0.4;     // of the points of the reference
// A camera that has moved less than this from its reference keyframe sees nothing new.
constexpr double kStillShare = 0.001;  // of the scene's median depth
constexpr double kStillRadians = 0.001;

}  // namespace

Tracker::Tracker(const View& view, const TrackingOptions& options)
    : view_(view), options_(options) {}

void Tracker::start_from(std::shared_ptr<const Frame> frame, const SE3& T_wc,
                         const std::shared_ptr<const MapView>& view,
                         const std::vector<PointId>& points) {
  map_ = view;
  last_ = {};
  last_.frame = std::move(frame);
  last_.T_wc = T_wc;
  last_.reference = view->reference;
  last_.T_rc = view->pose_of(view->reference).value().inverse() * T_wc;
  last_.last_birth = view->newest;
  last_.points = points;
  last_.aligned.assign(points.size(), 0);
  last_points_.clear();
  for (const PointId id : points)
    last_points_.push_back(id.valid() ? view->index_of(id) : kNoPoint);
  has_velocity_ = false;
  frames_since_start_ = 0;
}

// A new view: the last frame moves with its reference keyframe, its points get new indices.
void Tracker::adopt_view(const std::shared_ptr<const MapView>& view) {
  if (map_ == view) return;
  map_ = view;
  if (const auto T_wr = view->pose_of(last_.reference)) last_.T_wc = *T_wr * last_.T_rc;
  for (std::size_t i = 0; i < last_.points.size(); ++i) {
    last_points_[i] = last_.points[i].valid() ? view->index_of(last_.points[i]) : kNoPoint;
  }
}

SE3 Tracker::predict(double timestamp) const {
  if (!has_velocity_) return last_.T_wc;
  const double dt = timestamp - last_.frame->timestamp;
  if (std::abs(dt - velocity_seconds_) < 1e-3) return last_.T_wc * velocity_;
  return last_.T_wc * SE3::exp(velocity_.log() * (dt / velocity_seconds_));
}

// Seconds since the last frame.
double Tracker::step_to(double timestamp) const {
  return std::max(timestamp - last_.frame->timestamp, kLeastStep);
}

// Of the camera since the last frame, should it be at T_wc; none where that was too long ago.
Vector6d Tracker::velocity_at(double timestamp, const SE3& T_wc) const {
  const double dt = std::max(timestamp - last_.frame->timestamp, 1e-6);
  if (dt > kEvenMotion) return Vector6d::Zero();
  return (last_.T_wc.inverse() * T_wc).log() / dt;
}

// Points that are matched say how deep they are; the others are taken to be as deep as most.
void Tracker::unroll(Frame& frame, const SE3& T_wc) {
  const SE3 T_cw = T_wc.inverse();
  depths_.assign(frame.size(), map_->median_depth);
  for (std::size_t i = 0; i < current_points_.size(); ++i) {
    if (current_points_[i] == kNoPoint) continue;
    const double z = (T_cw * map_->points[current_points_[i]].position).z();
    if (z > 0) depths_[i] = z;
  }
  cairn::unroll(frame, view_.pinhole(), depths_, map_->readout, velocity_at(frame.timestamp, T_wc));
}

void Tracker::unroll_observations(const Frame& frame, const SE3& T_wc) {
  const SE3 T_cw = T_wc.inverse();
  const Vector6d motion = map_->readout * velocity_at(frame.timestamp, T_wc);
  for (std::size_t k = 0; k < observations_.size(); ++k) {
    const std::uint32_t i = observed_keypoints_[k];
    const double z = (T_cw * observations_[k].position).z();
    if (!(z > 0)) continue;
    observations_[k].pixel =
        seen_at_once(view_.pinhole(), frame.sighted_pixel(i), z, frame.moment(i), motion);
  }
}

const TrackedFrame* Tracker::track(std::shared_ptr<Frame> frame,
                                   const std::shared_ptr<const MapView>& view, FrameRecord& record,
                                   const PlanesInSight& planes_in_sight, const Picture* picture) {
  Stopwatch watch;
  adopt_view(view);
  support_.reset();
  SE3 T_wc = predict(frame->timestamp);
  if (has_velocity_) support_ = {{}, expected_motion(T_wc, frame->timestamp)};
  current_points_.clear();  // none is known yet
  aligned_.assign(frame->size(), 0);
  unroll(*frame, T_wc);
  bool ok = track_motion(*frame, T_wc);
  if (!ok) {
    support_.reset();
    T_wc = last_.T_wc;
    ok = track_reference(*frame, T_wc);
  }
  record.predict_ms = watch.lap();
  if (ok) ok = track_local_map(*frame, picture, T_wc);
  if (planes_in_sight && map_->units_a_metre > 0 &&
      (!ok || std::count(inlier_.begin(), inlier_.end(), 1) < options_.few_points)) {
    ok = track_supported(*frame, picture, T_wc, planes_in_sight()) || ok;
  }
  record.matches = static_cast<int>(observations_.size());
  record.inliers = static_cast<int>(std::count(inlier_.begin(), inlier_.end(), 1));
  record.local_map_ms = watch.lap();
  if (!ok) return nullptr;

  unroll(*frame, T_wc);
  has_velocity_ = true;
  velocity_ = last_.T_wc.inverse() * T_wc;
  velocity_seconds_ = std::max(frame->timestamp - last_.frame->timestamp, 1e-6);
  ++frames_since_start_;
  last_.frame = std::move(frame);
  last_.T_wc = T_wc;
  last_.reference = map_->reference;
  last_.T_rc = map_->pose_of(map_->reference).value().inverse() * T_wc;
  last_.last_birth = map_->newest;
  last_.matches = record.matches;
  last_.inliers = record.inliers;
  last_points_ = current_points_;
  last_.aligned = aligned_;
  last_.points.assign(last_points_.size(), {});
  for (std::size_t i = 0; i < last_points_.size(); ++i) {
    if (last_points_[i] != kNoPoint) last_.points[i] = map_->points[last_points_[i]].id;
  }
  return &last_;
}

// Constant velocity: the points of the last frame are looked for where the motion puts them.
bool Tracker::track_motion(const Frame& frame, SE3& T_wc) {
  const SE3 T_cw = T_wc.inverse();
  for (const double widen : {1.0, 2.5}) {
    expected_.clear();
    for (std::size_t i = 0; i < last_points_.size(); ++i) {
      const std::uint32_t index = last_points_[i];
      if (index == kNoPoint) continue;
      const MapView::Point& p = map_->points[index];
      const Eigen::Vector3d X = T_cw * p.position;
      if (!(X.z() > 0)) continue;
      const Eigen::Vector2d uv = view_.pinhole().project(X);
      if (!view_.contains(uv)) continue;
      const int octave = last_.frame->octave(i);
      const double radius = widen * options_.search_radius * std::sqrt(view_.scale(octave));
      expected_.push_back({index, uv.cast<float>(), static_cast<float>(radius),
                           static_cast<std::int16_t>(octave - 1),
                           static_cast<std::int16_t>(octave + 1), &p.descriptor});
    }
    current_points_.assign(frame.size(), kNoPoint);
    if (search_by_projection(frame, expected_, {80, 0.9}, current_points_) >= kMinMatches) break;
  }
  SE3 pose = T_wc;
  const int least =
      sees_planes() ? options_.min_supported_inliers : options_.min_prediction_inliers;
  if (adjust(frame, pose) < least) return false;
  T_wc = pose;
  return true;
}

// Points are few: planes that the picture shows, and the motion so far, hold the camera with them.
bool Tracker::track_supported(Frame& frame, const Picture* picture, SE3& T_wc,
                              const std::vector<SeenPlane>& planes) {
  SE3 pose = predict(frame.timestamp);
  support_ = support(pose, frame.timestamp, planes);
  if (support_->planes.empty()) return false;
  // Where the motion leads nowhere, the whole map around may know more.
  if (!track_motion(frame, pose)) current_points_.assign(frame.size(), kNoPoint);
  if (!track_local_map(frame, picture, pose)) return false;
  T_wc = pose;
  return true;
}

PoseSupport Tracker::support(const SE3& T_wc, double timestamp,
                             const std::vector<SeenPlane>& planes) const {
  const SE3 T_cw = T_wc.inverse();
  std::vector<KnownPlane> known;
  for (const MapView::PlanePose& plane : map_->planes) {
    if (plane.sigma_tilt > kUnsureTilt) continue;
    known.push_back(
        KnownPlane{plane.id, plane.plane, plane.outline, plane.sigma_tilt}.transformed(T_cw));
  }
  PoseSupport support{{}, expected_motion(T_wc, timestamp)};
  // Each frame is held by them, and they err alike for many.
  const double alike = std::sqrt(std::max(kNetworkErrorsLast / step_to(timestamp), 1.0));
  for (const SeenPlane& metric : planes) {
    const SeenPlane seen = metric.scaled(map_->units_a_metre);
    const KnownPlane* plane = nearest_surface(seen, known, kLoose);
    if (plane == nullptr) continue;
    support.planes.emplace_back(
        FactorForm::kRobust,
        PlaneMeasurement::isotropic(seen.plane.facing_origin().normal(), seen.centroid,
                                    alike * std::hypot(seen.sigma_angle, plane->sigma_tilt),
                                    alike * seen.sigma_offset),
        plane->plane.transformed(T_wc));
  }
  return support;
}

// As surely as a camera goes on as it went: of little weight beside many points all over a picture.
PosePrior Tracker::expected_motion(const SE3& T_wc, double timestamp) const {
  const double dt = step_to(timestamp);
  const double depth = std::max(map_->median_depth, kLeastDepth);
  PosePrior prior{T_wc};
  prior.sigma << Eigen::Vector3d::Constant(kAcceleration * dt * dt * depth),
      Eigen::Vector3d::Constant(kTurnAcceleration * dt * dt);
  return prior;
}

// No usable motion: all points of the reference keyframe are compared by descriptor.
bool Tracker::track_reference(const Frame& frame, SE3& T_wc) {
  const Frame& reference = *map_->reference_frame;
  current_points_.assign(frame.size(), kNoPoint);
  MatchOptions match_options;
  for (const auto& m : match_mutual(reference.features, frame.features, match_options)) {
    const std::uint32_t point = map_->reference_points[m.first];
    if (point != kNoPoint) current_points_[m.second] = point;
  }
  for (const SE3& start : {T_wc, map_->pose_of(map_->reference).value()}) {
    SE3 pose = start;
    const std::vector<std::uint32_t> matched = current_points_;
    if (adjust(frame, pose) >= options_.min_prediction_inliers) {
      T_wc = pose;
      return true;
    }
    current_points_ = matched;
  }
  return false;
}

bool Tracker::track_local_map(Frame& frame, const Picture* picture, SE3& T_wc) {
  const SE3 T_cw = T_wc.inverse();
  const Eigen::Vector3d camera = T_wc.translation();
  seen_.assign(map_->points.size(), 0);
  for (const std::uint32_t p : current_points_) {
    if (p != kNoPoint) seen_[p] = 1;
  }
  expected_.clear();
  last_.visible.clear();
  const bool astray = sees_planes() && std::all_of(current_points_.begin(), current_points_.end(),
                                                   [](std::uint32_t p) { return p == kNoPoint; });
  const double widen = astray ? 4.0 : frames_since_start_ < kCautiousFrames ? 2.0 : 1.0;
  for (std::uint32_t i = 0; i < map_->points.size(); ++i) {
    const MapView::Point& p = map_->points[i];
    if (seen_[i]) {
      last_.visible.push_back(p.id);
      continue;
    }
    const Visibility v =
        predict_visibility(view_, T_cw, camera, p.position, p.normal, p.base_distance);
    if (!v.visible) continue;
    last_.visible.push_back(p.id);
    const double radius = widen * (v.cosine > kFrontalCosine ? 2.5 : 4.0) * view_.scale(v.octave);
    expected_.push_back({i, v.pixel.cast<float>(), static_cast<float>(radius),
                         static_cast<std::int16_t>(v.octave - 1),
                         static_cast<std::int16_t>(v.octave + 1), &p.descriptor});
  }
  search_by_projection(frame, expected_, {100, 0.8}, current_points_);
  if (picture != nullptr) align(frame, *picture, T_cw);
  const int least = sees_planes() ? options_.min_supported_inliers : options_.min_inliers;
  return adjust(frame, T_wc, true) >= least;
}

// Corners are found anew in each picture, to half a pixel. What a point looked like is found again
// to a fraction of that.
void Tracker::align(Frame& frame, const Picture& picture, const SE3& T_cw) {
  for (std::size_t i = 0; i < current_points_.size(); ++i) {
    if (current_points_[i] == kNoPoint) continue;
    const MapView::Point& p = map_->points[current_points_[i]];
    if (!p.patch) continue;
    const Eigen::Vector2d pixel = frame.sighted_pixel(i);
    const auto found = find_patch(*p.patch, picture, view_.pinhole(), T_cw, p.position, pixel);
    aligned_[i] = found.has_value();
    if (found) frame.move(i, *found - pixel);
  }
}

// Motion-only adjustment of the current matches; those that do not agree are let go. `unroll`: from
// where an instant shutter would have seen them, as the motion that is found says.
int Tracker::adjust(const Frame& frame, SE3& T_wc, bool unroll) {
  observations_.clear();
  observed_keypoints_.clear();
  for (std::uint32_t i = 0; i < current_points_.size(); ++i) {
    if (current_points_[i] == kNoPoint) continue;
    observations_.push_back({map_->points[current_points_[i]].position, frame.pixel(i),
                             view_.sigma(frame.octave(i), aligned_[i] != 0)});
    observed_keypoints_.push_back(i);
  }
  const auto adjust = [&] {
    return adjust_pose(observations_, view_.pinhole(), T_wc, inlier_,
                       support_ ? &*support_ : nullptr);
  };
  PoseAdjustmentSummary summary = adjust();
  // How the camera moves while its shutter rolls is known once its pose is.
  if (unroll && summary.usable && map_->readout != 0 && !frame.rows.empty()) {
    unroll_observations(frame, T_wc);
    summary = adjust();
  }
  for (std::size_t k = 0; k < observed_keypoints_.size(); ++k) {
    if (!inlier_[k]) current_points_[observed_keypoints_[k]] = kNoPoint;
  }
  return summary.usable ? summary.inliers : 0;
}

bool Tracker::wants_keyframe(int before_it) const {
  const bool moved = last_.T_rc.translation().norm() > kStillShare * map_->median_depth ||
                     Eigen::AngleAxisd(last_.T_rc.rotation()).angle() > kStillRadians;
  const bool weak = last_.inliers < kWeakShare * map_->reference_tracked;
  if (last_.inliers < kFewestOfKeyframe && !sees_planes()) return false;
  // Each picture from elsewhere says something: the mapper takes as many as it has time for, and
  // lets those go that others make redundant. One that is behind would only fall farther behind:
  // its newest map shows an ever older place, where ever less is found.
  return (before_it == 0 && moved) || (before_it < kMostWaiting && weak);
}

}  // namespace cairn
