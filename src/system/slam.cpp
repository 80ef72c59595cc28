#include "cairn/system/slam.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>
#include <opencv2/imgproc.hpp>

#include "cairn/map/stopwatch.h"
#include "cairn/system/frame_log.h"
#include "cairn/system/mapping_schedule.h"
#include "cairn/system/perception_worker.h"
#include "cairn/system/result.h"

namespace cairn {
namespace {

constexpr double kYoungMap = 4.0;  // seconds: a map lost so early is not worth going back to
// What so many frames between two keyframes saw is all that the mapper needs to hear; a camera that
// stands still sees the same for ever.
constexpr int kSightingFrames = 30;
constexpr int kRestartAfter = 8;  // lost frames, before a young map is given up
// Points find most lost cameras at once. To look at a picture costs as much as several frames do:
// of so many questions one is asked with objects, the second one first.
constexpr int kQuestionsALook = 5;
constexpr std::size_t kLeastObjects = 3;  // of the map, that a place can be told by

// A thousand keypoints for each 640 pixels of width, where the user left the number open.
Options resolved(Options options, const Camera& camera) {
  if (options.features.count == 0) {
    options.features.count =
        std::max(500, static_cast<int>(std::lround(1000.0 * camera.width() / 640)));
  }
  options.mapping.planes.manhattan =
      options.landmarks == Landmarks::kPpm || options.landmarks == Landmarks::kFull;
  options.mapping.objects.supports = options.landmarks == Landmarks::kFull;
  if (options.pace == Pace::kRealtime) {  // no two runs are the same there
    options.mapping.adjustment.full_threads =
        options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  }
  return options;
}

}  // namespace

struct Slam::Implementation {
  Implementation(const Camera& camera, const Options& given, std::unique_ptr<PlaneDetector> planes)
      : camera(camera),
        options(resolved(given, camera)),
        view(camera, options.features.levels, options.features.scale, options.tracking.sigma_px),
        undistorter(camera),
        extractor(options.features),
        initializer(view, options.initialization, options.seed),
        tracker(view, options.tracking) {
    if (options.threads > 0) {
      threads.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    }
    if (planes && options.landmarks != Landmarks::kPoints) {
      perception = std::make_unique<PerceptionWorker>(
          std::move(planes), camera, view, options.pace == Pace::kRealtime,
          [this](KeyframePerception seen) { deliver(std::move(seen)); });
    }
  }

  std::shared_ptr<Frame> make_frame(const cv::Mat& picture, double timestamp);
  void initialise(const std::shared_ptr<const Frame>& frame, FrameRecord& record);
  bool track(const std::shared_ptr<Frame>& frame, const PerceptionInput& input,
             FrameRecord& record);
  void lose(const std::shared_ptr<const Frame>& frame, FrameRecord& record);
  bool recover(const std::shared_ptr<Frame>& frame, const PerceptionInput& input,
               FrameRecord& record);
  std::vector<SeenObject> objects_in_sight(const std::shared_ptr<const Frame>& frame,
                                           const PerceptionInput& input);
  bool place_by_objects(const MappingSchedule::Answer& answer,
                        const std::shared_ptr<const Frame>& frame);
  void log_tracked();
  std::shared_ptr<const Picture> picture_to_align() const;
  void hand_over_keyframe();
  void deliver(KeyframePerception seen);
  void catch_up(const GoOn& go_on);
  void restart();
  std::vector<FrameResult::Feature> seen_features(const Frame& frame, FrameState state) const;

  Camera camera;
  Options options;
  View view;
  Undistorter undistorter;
  OrbExtractor extractor;
  Features extracted;  // reused between frames
  Initializer initializer;
  Tracker tracker;
  std::optional<tbb::global_control> threads;
  std::mutex mapping_mutex;                  // the map may start again while a picture is looked at
  std::unique_ptr<MappingSchedule> mapping;  // once there is a map
  std::unique_ptr<PerceptionWorker> perception;
  MappingSchedule::Sighting sighting;
  int frames_since_keyframe = 0;
  FrameLog log;
  bool lost = false;
  int lost_frames = 0;
  int questions = 0;  // where the camera is, since it was lost
  double map_started = 0;
  int restarts = 0;
  std::vector<SlamResult::Gap> gaps;
  std::vector<FrameRecord> records;
};

Slam::Slam(const Camera& camera, const Options& options, std::unique_ptr<PlaneDetector> planes)
    : implementation_(std::make_unique<Implementation>(camera, options, std::move(planes))) {}
Slam::~Slam() = default;

const std::vector<FrameRecord>& Slam::frames() const { return implementation_->records; }

std::shared_ptr<const MapView> Slam::snapshot() const {
  return implementation_->mapping ? implementation_->mapping->view() : nullptr;
}

void Slam::drop(double timestamp) {
  implementation_->records.push_back({.timestamp = timestamp, .state = FrameState::kDropped});
}

void Slam::skip(double timestamp) {
  implementation_->records.push_back({.timestamp = timestamp, .state = FrameState::kSkipped});
}

// Where keypoints lie in the picture as it was given, with the bend of its lens.
std::vector<FrameResult::Feature> Slam::Implementation::seen_features(const Frame& frame,
                                                                      FrameState state) const {
  const bool tracked = state == FrameState::kTracked && tracker.last().frame.get() == &frame;
  std::vector<FrameResult::Feature> features;
  features.reserve(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const Eigen::Vector2f pixel =
        camera.project(view.pinhole().unproject(frame.sighted_pixel(i))).cast<float>();
    features.push_back({pixel.x(), pixel.y(), tracked && tracker.last().points[i].valid()});
  }
  return features;
}

std::shared_ptr<Frame> Slam::Implementation::make_frame(const cv::Mat& picture, double timestamp) {
  auto frame = std::make_shared<Frame>();
  frame->timestamp = timestamp;
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  extractor.extract(grey, extracted);
  for (Keypoint& kp : extracted.keypoints) {
    const int c = std::clamp(static_cast<int>(std::lround(kp.x)), 0, picture.cols - 1);
    const int r = std::clamp(static_cast<int>(std::lround(kp.y)), 0, picture.rows - 1);
    if (picture.channels() == 1) {
      const auto level = picture.at<unsigned char>(r, c);
      kp.colour = {level, level, level};
    } else {
      const auto& bgr = picture.at<cv::Vec3b>(r, c);
      kp.colour = {bgr[2], bgr[1], bgr[0]};
    }
  }
  undistorter.apply(extracted, &frame->rows);
  frame->features = extracted;  // a copy that holds no more memory than it needs
  frame->grid.build(frame->features.keypoints);
  return frame;
}

FrameResult Slam::process(const cv::Mat& picture, double timestamp, const cv::Mat& depth) {
  Implementation& s = *implementation_;
  const Stopwatch watch;
  FrameResult result;
  FrameRecord& record = result.record;
  record.timestamp = timestamp;
  const std::shared_ptr<Frame> frame = s.make_frame(picture, timestamp);
  record.extract_ms = watch.milliseconds();
  const PerceptionInput input{picture, depth, timestamp};
  double mapping_ms = 0;
  if (!s.mapping) {
    s.initialise(frame, record);
  } else if (s.lost ? s.recover(frame, input, record) : s.track(frame, input, record)) {
    record.state = FrameState::kTracked;
    result.T_wc = s.tracker.last().T_wc;
    s.log_tracked();
    if (!s.lost && s.tracker.wants_keyframe(s.mapping->backlog())) {
      record.keyframe = true;
      const Stopwatch of_mapping;
      s.hand_over_keyframe();
      mapping_ms = of_mapping.milliseconds();
    }
  } else {
    s.lose(frame, record);
  }
  if (s.perception && s.options.look_at_every_frame) s.perception->look_now(frame, input);
  if (record.keyframe) {
    const Stopwatch of_mapping;
    if (s.perception) s.perception->look(frame, input);
    s.mapping->settle();
    mapping_ms += of_mapping.milliseconds();
  }
  record.total_ms = watch.milliseconds() - mapping_ms;
  result.features = s.seen_features(*frame, record.state);
  if (s.perception) {
    DetectedFrame found = s.perception->take_found();
    result.planes = std::move(found.planes);
    result.objects = std::move(found.objects);
  }
  s.records.push_back(record);
  return result;
}

void Slam::Implementation::initialise(const std::shared_ptr<const Frame>& frame,
                                      FrameRecord& record) {
  const Stopwatch watch;
  record.state = FrameState::kInitialising;
  const std::optional<InitialPair> pair = initializer.add(frame, picture_to_align());
  record.predict_ms = watch.milliseconds();
  if (!pair) return;
  auto mapper = std::make_unique<Mapper>(view, options.mapping);
  if (!mapper->initialize(*pair)) return;
  const std::shared_ptr<const MapView> map_view = mapper->view();
  {
    const std::lock_guard lock(mapping_mutex);
    mapping = std::make_unique<MappingSchedule>(std::move(mapper), options);
  }
  initializer.reset();  // lets the first frame and its picture go
  map_started = frame->timestamp;
  std::vector<PointId> points(frame->size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t p = map_view->reference_points[i];
    if (p != MapView::kNone) points[i] = map_view->points[p].id;
  }
  const SE3 T_wc = map_view->pose_of(map_view->reference).value();
  tracker.start_from(frame, T_wc, map_view, points);
  log.add(frame->timestamp, map_view->reference, SE3(), T_wc);
  record.state = FrameState::kTracked;
  record.keyframe = true;
  record.matches = record.inliers = static_cast<int>(map_view->points.size());
  spdlog::info("map initialised at {:.3f} s with {} points", frame->timestamp,
               map_view->points.size());
}

bool Slam::Implementation::track(const std::shared_ptr<Frame>& frame, const PerceptionInput& input,
                                 FrameRecord& record) {
  PlanesInSight planes_in_sight;
  if (perception && has_planes(options.landmarks)) {
    planes_in_sight = [&] { return perception->planes_now(frame, input); };
  }
  const Picture picture{extractor.pyramid(), &undistorter};
  const TrackedFrame* tracked = tracker.track(frame, mapping->view(), record, planes_in_sight,
                                              options.tracking.align ? &picture : nullptr);
  if (tracked == nullptr) return false;
  if (++frames_since_keyframe > kSightingFrames) return true;
  sighting.visible.insert(sighting.visible.end(), tracked->visible.begin(), tracked->visible.end());
  for (const PointId p : tracked->points) {
    if (p.valid()) sighting.found.push_back(p);
  }
  return true;
}

void Slam::Implementation::log_tracked() {
  const TrackedFrame& t = tracker.last();
  log.add(t.frame->timestamp, t.reference, t.T_rc, t.T_wc,
          sightings_of(*t.frame, t.points, t.aligned), t.last_birth);
}

// The present one, to keep; null where keypoints stay at their corners.
std::shared_ptr<const Picture> Slam::Implementation::picture_to_align() const {
  if (!options.tracking.align) return nullptr;
  return std::make_shared<Picture>(Picture{extractor.pyramid().clone(), &undistorter});
}

void Slam::Implementation::hand_over_keyframe() {
  const TrackedFrame& t = tracker.last();
  KeyframeCandidate candidate{t.frame, t.reference, t.T_rc, t.points, t.aligned};
  candidate.picture = picture_to_align();
  mapping->insert(std::move(candidate), std::move(sighting));
  sighting = {};
  frames_since_keyframe = 0;
}

// In realtime mostly from the worker's thread.
void Slam::Implementation::deliver(KeyframePerception seen) {
  const std::lock_guard lock(mapping_mutex);
  // A detector may see more than the map is to hold.
  if (!has_planes(options.landmarks)) seen.planes.clear();
  if (!has_objects(options.landmarks)) seen.objects.clear();
  if (mapping) mapping->join(std::move(seen));
}

// What realtime had no time to look at, of the keyframes that are left.
void Slam::Implementation::catch_up(const GoOn& go_on) {
  perception->stop();
  const Mapper& mapper = mapping->stop();
  perception->catch_up([&](const Frame& frame) { return mapper.keyframe_of(frame).valid(); },
                       [&](std::size_t done, std::size_t all) {
                         return !go_on || go_on({Finishing::Stage::kLooking, done, all});
                       });
}

void Slam::Implementation::lose(const std::shared_ptr<const Frame>& frame, FrameRecord& record) {
  record.state = FrameState::kLost;
  if (!lost) {
    spdlog::info("lost at {:.3f} s", frame->timestamp);
    gaps.push_back({frame->timestamp, std::numeric_limits<double>::quiet_NaN()});
    lost = true;
    lost_frames = 0;
    questions = 0;
  }
  ++lost_frames;
  if (lost_frames >= kRestartAfter && gaps.back().lost - map_started < kYoungMap) restart();
}

// A lost frame: asks where it is; goes on from the answer once there is one.
bool Slam::Implementation::recover(const std::shared_ptr<Frame>& frame,
                                   const PerceptionInput& input, FrameRecord& record) {
  const Stopwatch watch;
  if (!mapping->relocalizing()) {
    std::vector<SeenObject> objects;
    if (questions++ % kQuestionsALook == 1) objects = objects_in_sight(frame, input);
    mapping->relocalize(frame, options.seed + records.size(), std::move(objects));
  }
  const std::optional<MappingSchedule::Answer> answer = mapping->take_relocalization();
  record.predict_ms = watch.milliseconds();
  if (!answer || !answer->found) return false;
  tracker.start_from(answer->frame, answer->found->T_wc, answer->found->view,
                     answer->found->points);
  record.inliers = record.matches = answer->found->inliers;
  if (answer->found->inliers == 0) return place_by_objects(*answer, frame);
  // In realtime the answer is for an earlier frame: the present one is tracked from there.
  if (answer->frame != frame && !track(frame, input, record)) return false;
  lost = false;
  gaps.back().recovered = frame->timestamp;
  spdlog::info("found again at {:.3f} s with {} points", frame->timestamp, record.inliers);
  return true;
}

// Of a lost frame; nothing where the map has too few that they could tell its place.
std::vector<SeenObject> Slam::Implementation::objects_in_sight(
    const std::shared_ptr<const Frame>& frame, const PerceptionInput& input) {
  if (!options.tracking.relocalize_by_objects || !has_objects(options.landmarks)) return {};
  if (!perception || mapping->view()->objects.size() < kLeastObjects) return {};
  return perception->objects_now(frame, input);
}

// Objects alone say where a frame is: it has a pose, but there are no points from which tracking
// could go on, so the camera stays lost and is asked for again. Has the present frame a pose?
bool Slam::Implementation::place_by_objects(const MappingSchedule::Answer& answer,
                                            const std::shared_ptr<const Frame>& frame) {
  const double timestamp = answer.frame->timestamp;
  spdlog::info("lost, but {} objects say where it is at {:.3f} s", answer.found->objects,
               timestamp);
  if (answer.frame == frame) return true;
  // In realtime it is an earlier frame, passed over as lost; of this loss, not of an earlier one.
  const auto record = std::find_if(records.rbegin(), records.rend(),
                                   [&](const FrameRecord& r) { return r.timestamp == timestamp; });
  if (record == records.rend() || timestamp < gaps.back().lost) return false;
  record->state = FrameState::kTracked;
  log_tracked();
  return false;
}

void Slam::Implementation::restart() {
  spdlog::info("the map was lost within {:.0f} s of its start: starting again", kYoungMap);
  {
    const std::lock_guard lock(mapping_mutex);
    mapping.reset();
  }
  log = {};
  sighting = {};
  frames_since_keyframe = 0;
  lost = false;
  ++restarts;
}

SlamResult Slam::finish(const GoOn& go_on) {
  Implementation& s = *implementation_;
  SlamResult result;
  result.gaps = s.gaps;
  result.restarts = s.restarts;
  if (!s.mapping) {
    result.refusal = s.initializer.refusal();
    return result;
  }
  if (s.perception) s.catch_up(go_on);
  Mapper& mapper = s.mapping->stop();
  std::size_t steps = 0;
  const StopAsked stop = [&] {
    return go_on && !go_on({Finishing::Stage::kAdjusting, ++steps, mapper.most_steps()});
  };
  const AdjustmentSummary summary =
      mapper.finish(stop, s.log.keyframe_motions(mapper.map(), mapper.buried()));
  spdlog::info("full adjustment: {}", summary.to_string());
  const Map& map = mapper.map();
  result.trajectory = s.log.final_trajectory(map, mapper.buried());
  result.trajectory_live = s.log.live_trajectory();
  result.keyframes = keyframe_trajectory(map);
  map.points().for_each([&](PointId, const MapPoint& p) {
    const auto [r, g, b] = p.colour.rgb();
    result.points.push_back({p.position, {r, g, b}, static_cast<int>(p.observations.size())});
  });
  result.planes = describe_planes(map);
  result.objects = describe_objects(map);
  result.object_refusals = mapper.object_refusals();
  result.keyframe_times = mapper.times();
  result.scale = mapper.scale();
  if (s.options.scale > 0) result.scale = given_scale(result.scale, s.options.scale);
  if (result.scale.known()) to_metres(result);
  result.readout = map.readout();
  result.reprojection = reprojection_error(map);
  return result;
}

}  // namespace cairn
