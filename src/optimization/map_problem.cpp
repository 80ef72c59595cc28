#include "cairn/optimization/map_problem.h"

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace cairn {
namespace {

// Seconds. Most cameras read within a frame of a film; from one local adjustment to the next little
// is learnt, as they share most of what they see.
constexpr double kReadoutSigma = 0.02, kReadoutStep = 0.005, kLongestReadout = 0.05;
// How far off calibrations are: focal length 0.3 %, distortion 0.003, principal point 0.7 px. The
// errors of a point's observations are alike, so the data are less sure than they look, and what is
// known of the camera has to be firm: where motion hardly shows the lens, it must not drift away.
constexpr std::array<double, LensCorrection::kSize> kLensSigma = {0.003, 0.003, 0.003, 0.7, 0.7};

class AskToStop : public ceres::IterationCallback {
 public:
  explicit AskToStop(const StopAsked& stop) : stop_(stop) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    stopped = stop_();
    return stopped ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  bool stopped = false;

 private:
  const StopAsked& stop_;
};

// Ceres warns, past our log, where it is given more threads than there are cores.
int usable_threads(int asked) {
  return std::clamp(asked, 1, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

}  // namespace

MapProblem::MapProblem(Map& map, std::vector<KeyframeId> free, std::vector<KeyframeId> fixed,
                       std::vector<PointId> points, const AdjustmentOptions& options, double width,
                       bool full, bool refine_lens)
    : map_(map),
      full_(full),
      threads_(full ? usable_threads(options.full_threads) : 1),
      refine_lens_(refine_lens),
      lens_(map.lens()),
      estimate_readout_(options.estimate_readout && !refine_lens),
      readout_(map.readout_estimate()),
      readout_prior_(full ? 0 : map.readout_estimate(), full ? kReadoutSigma : kReadoutStep),
      keyframes_(std::move(free)),
      points_(std::move(points)),
      lens_prior_(kLensSigma),
      depths_(map, options.planes.predicted_depth),
      planes_(map, options.planes),
      objects_(map, options.objects),
      losses_(width) {
  free_count_ = keyframes_.size();
  keyframes_.insert(keyframes_.end(), fixed.begin(), fixed.end());
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const std::uint32_t slot = keyframes_[i].slot;
    if (slot >= index_of_slot_.size()) index_of_slot_.resize(slot + 1, -1);
    index_of_slot_[slot] = static_cast<int>(i);
  }
  if (full && options.weigh_landmarks) losses_.weigh_landmarks(map);
  build();
}

AdjustmentSummary MapProblem::solve(int iterations, double tolerance, const StopAsked& stop) {
  ceres::Solver::Options options;
  options.linear_solver_type = free_count_ > 60 ? ceres::SPARSE_SCHUR : ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering_;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.num_threads = threads_;
  options.logging_type = ceres::SILENT;
  AskToStop ask(stop);
  if (stop) options.callbacks.push_back(&ask);
  ceres::Solver::Summary s;
  ceres::Solve(options, problem_.get(), &s);

  AdjustmentSummary summary;
  summary.usable = s.IsSolutionUsable();
  summary.stopped = ask.stopped;
  summary.keyframes = static_cast<int>(free_count_);
  summary.points = static_cast<int>(points_.size());
  summary.observations = static_cast<int>(observations_.size());
  summary.iterations = static_cast<int>(s.iterations.size());
  const double n = std::max<std::size_t>(observations_.size(), 1);
  summary.initial_rms = std::sqrt(2 * s.initial_cost / n);
  summary.final_rms = std::sqrt(2 * s.final_cost / n);
  return summary;
}

void MapProblem::hold_steps(OdometryBlocks& odometry) {
  odometry.add_to(*problem_, [this](KeyframeId id) { return pose_of(id); });
}

void MapProblem::keep_unit() {
  const Eigen::Vector3d origin = map_.keyframes()[keyframes_[free_count_]].T_wc.translation();
  double before = 0, after = 0;
  for (std::size_t i = 0; i < free_count_; ++i) {
    const auto now = Eigen::Vector3d::Map(&pose_values_[7 * i + 4]);
    before += (map_.keyframes()[keyframes_[i]].T_wc.translation() - origin).squaredNorm();
    after += (now - origin).squaredNorm();
  }
  const double scale = std::sqrt(before / after);
  if (!std::isfinite(scale) || scale <= 0) return;
  auto move = [&](double* position) {
    auto p = Eigen::Vector3d::Map(position);
    p = origin + scale * (p - origin);
  };
  for (std::size_t i = 0; i < free_count_; ++i) move(&pose_values_[7 * i + 4]);
  for (std::size_t i = 0; i < points_.size(); ++i) move(&point_values_[3 * i]);
  planes_.scale(scale);
  objects_.scale(scale);
  depths_.scale(scale);
}

void MapProblem::write_back() {
  map_.set_lens(lens_);
  if (estimate_readout_) map_.set_readout(std::clamp(readout_, -kLongestReadout, kLongestReadout));
  for (std::size_t i = 0; i < free_count_; ++i) {
    map_.keyframes()[keyframes_[i]].T_wc = SE3Manifold::unpack(&pose_values_[7 * i]);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    map_.points()[points_[i]].position = Eigen::Vector3d::Map(&point_values_[3 * i]);
  }
  planes_.write_back(map_);
  objects_.write_back(map_);
  depths_.write_back(map_);
}

int MapProblem::erase_outliers(double gate) {
  int erased = 0;
  for (const Edge& edge : observations_) {
    const KeyframeId keyframe = keyframes_[edge.keyframe];
    const PointId point = points_[edge.point];
    if (!map_.points().contains(point) || map_.keypoint_of(point, keyframe) < 0) continue;
    const int octave = map_.keyframes()[keyframe].frame->octave(edge.keypoint);
    const Eigen::Vector2d off =
        map_.reprojection_error(keyframe, edge.keypoint, map_.points()[point].position);
    if ((off / map_.view().sigma(octave, edge.aligned)).squaredNorm() < gate) continue;
    map_.erase_observation(point, keyframe);
    ++erased;
  }
  for (const PointId id : points_) {
    if (map_.points().contains(id)) map_.update_geometry(id);
  }
  return erased;
}

void MapProblem::build() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  problem_ = std::make_unique<ceres::Problem>(options);
  ordering_ = std::make_shared<ceres::ParameterBlockOrdering>();
  collect();
  pose_values_.resize(7 * keyframes_.size());
  point_values_.resize(3 * points_.size());
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    SE3Manifold::pack(map_.keyframes()[keyframes_[i]].T_wc, &pose_values_[7 * i]);
    problem_->AddParameterBlock(&pose_values_[7 * i], 7, &manifold_);
    ordering_->AddElementToGroup(&pose_values_[7 * i], kPoseGroup);
    if (i >= free_count_) problem_->SetParameterBlockConstant(&pose_values_[7 * i]);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Eigen::Vector3d::Map(&point_values_[3 * i]) = map_.points()[points_[i]].position;
    problem_->AddParameterBlock(&point_values_[3 * i], 3);
    ordering_->AddElementToGroup(&point_values_[3 * i], kPointGroup);
  }
  if (refine_lens_) ordering_->AddElementToGroup(lens_.values.data(), kLensGroup);
  for (const Edge& edge : observations_) {
    const Frame& frame = *map_.keyframes()[keyframes_[edge.keyframe]].frame;
    const Pinhole& pinhole = map_.view().pinhole();
    const double sigma = map_.view().core(frame.octave(edge.keypoint), edge.aligned);
    ceres::LossFunction* loss = losses_.of(points_[edge.point], edge.aligned);
    double* pose = &pose_values_[std::size_t{7} * edge.keyframe];
    double* point = &point_values_[std::size_t{3} * edge.point];
    if (estimate_readout_ && frame.rolls()) {
      rolling_factors_.emplace_back(pinhole, frame.pixel(edge.keypoint), sigma, frame.readout,
                                    drift(edge));
      problem_->AddResidualBlock(&rolling_factors_.back(), loss, pose, point, &readout_);
    } else if (refine_lens_) {
      lens_factors_.emplace_back(pinhole, frame.pixel(edge.keypoint), sigma);
      problem_->AddResidualBlock(&lens_factors_.back(), loss, pose, point, lens_.values.data());
    } else {
      factors_.emplace_back(pinhole, frame.pixel(edge.keypoint), sigma);
      problem_->AddResidualBlock(&factors_.back(), loss, pose, point);
    }
  }
  if (depths_.wanted()) add_depths();
  if (!map_.planes().empty() || !map_.objects().empty()) add_landmarks();
  hold_unit();
  if (!rolling_factors_.empty()) {
    ordering_->AddElementToGroup(&readout_, kLensGroup);
    problem_->AddResidualBlock(&readout_prior_, nullptr, &readout_);
  }
  if (refine_lens_) problem_->AddResidualBlock(&lens_prior_, nullptr, lens_.values.data());
}

// Pixels by which an instant shutter would have seen a keypoint elsewhere, were the readout one
// second longer.
Eigen::Vector2d MapProblem::drift(const Edge& edge) const {
  const Keyframe& keyframe = map_.keyframes()[keyframes_[edge.keyframe]];
  const double z = (keyframe.T_wc.inverse() * map_.points()[points_[edge.point]].position).z();
  if (!(z > 0)) return Eigen::Vector2d::Zero();
  return drift_by_readout(*keyframe.frame, edge.keypoint, map_.view().pinhole(), z);
}

void MapProblem::add_depths() {
  std::vector<DepthBlocks::Sight> sights;
  sights.reserve(observations_.size());
  for (const Edge& e : observations_) {
    sights.push_back({keyframes_[e.keyframe], points_[e.point], e.keypoint,
                      &pose_values_[std::size_t{7} * e.keyframe],
                      &point_values_[std::size_t{3} * e.point]});
  }
  depths_.add_to(*problem_, *ordering_, sights, full_);
}

// Null for keyframes that are no part of this.
double* MapProblem::pose_of(KeyframeId id) {
  const int i = id.slot < index_of_slot_.size() ? index_of_slot_[id.slot] : -1;
  return i < 0 ? nullptr : &pose_values_[std::size_t{7} * std::size_t(i)];
}

// Planes first: objects stand on them.
void MapProblem::add_landmarks() {
  poses_.emplace(map_, *problem_, *ordering_, [this](KeyframeId id) { return pose_of(id); });
  planes_.add_to(*problem_, *ordering_, *poses_, [this](PointId id) {
    const auto at = std::lower_bound(points_.begin(), points_.end(), id);
    return at == points_.end() || *at != id ? nullptr
                                            : &point_values_[3 * std::size_t(at - points_.begin())];
  });
  objects_.add_to(*problem_, *ordering_, *poses_, planes_);
}

// With one keyframe held, the scale hangs on the distance to the keyframe that is farthest from
// it.
void MapProblem::hold_unit() {
  if (keyframes_.size() != free_count_ + 1) return;
  const Eigen::Vector3d origin = map_.keyframes()[keyframes_[free_count_]].T_wc.translation();
  std::size_t farthest = 0;
  double length = 0;
  for (std::size_t i = 0; i < free_count_; ++i) {
    const double d = (map_.keyframes()[keyframes_[i]].T_wc.translation() - origin).norm();
    if (d > length) {
      length = d;
      farthest = i;
    }
  }
  if (length <= 0) return;
  unit_ = std::make_unique<UnitFactor>(origin, length);
  problem_->AddResidualBlock(unit_.get(), nullptr, &pose_values_[7 * farthest]);
}

void MapProblem::collect() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (const Observation& o : map_.points()[points_[i]].observations) {
      const int keyframe =
          o.keyframe.slot < index_of_slot_.size() ? index_of_slot_[o.keyframe.slot] : -1;
      if (keyframe < 0) continue;
      if (!full_ && !map_.is_corner(o)) continue;
      observations_.push_back({static_cast<std::uint32_t>(keyframe), static_cast<std::uint32_t>(i),
                               o.keypoint, o.aligned()});
    }
  }
}

}  // namespace cairn
