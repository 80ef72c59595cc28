#include "cairn/optimization/plane_blocks.h"

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/optimization/factors/coplanar_planes_factor.h"
#include "cairn/optimization/factors/parallel_planes_factor.h"
#include "cairn/optimization/factors/perpendicular_planes_factor.h"
#include "cairn/optimization/factors/plane_observation_factor.h"
#include "cairn/optimization/factors/point_on_plane_factor.h"
#include "cairn/optimization/factors/two_rows.h"

namespace cairn {
namespace {

constexpr std::size_t kMinPoints = 3;        // of a plane in the adjustment, that it takes part
constexpr std::size_t kMaxHeldPoints = 200;  // outside of the adjustment, that hold a plane
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kFlattest = 0.001;      // share of the viewing distance
constexpr double kPointsToBeSure = 100;  // half as sure of it with so many

}  // namespace

void PlaneBlocks::add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering,
                         PoseBlocks& poses, const PointBlock& point_of) {
  problem_ = &problem;
  ordering_ = &ordering;
  poses_ = &poses;
  point_of_ = point_of;
  losses_.push_back(std::make_unique<ceres::HuberLoss>(2.0));
  losses_.push_back(std::make_unique<ceres::CauchyLoss>(1.0));
  planes_.reserve(map_.planes().size());
  held_points_.reserve(kMaxHeldPoints * map_.planes().size());
  map_.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!takes_part(landmark)) return;
    Entry& entry = planes_.emplace_back();
    entry.id = id;
    Eigen::Map<Eigen::Vector4d>(entry.values.data()) = landmark.plane.coefficients();
    problem.AddParameterBlock(entry.values.data(), 4, &plane_manifold_);
    ordering.AddElementToGroup(entry.values.data(), kPlaneGroup);
  });
  for (Entry& entry : planes_) {
    if (options_.observation.use) add_observations(entry);
    if (options_.point_on_plane.use && map_.planes()[entry.id].confirmed) add_points(entry);
  }
  add_relations();
}

bool PlaneBlocks::takes_part(const PlaneLandmark& landmark) const {
  const auto seen =
      std::any_of(landmark.observations.begin(), landmark.observations.end(),
                  [&](const PlaneObservation& o) { return poses_->own(o.keyframe) != nullptr; });
  if (seen && options_.observation.use) return true;
  std::size_t points = 0;
  for (const PointId p : landmark.points) points += point_of_(p) != nullptr;
  return points >= kMinPoints && options_.point_on_plane.use;
}

void PlaneBlocks::add_observations(Entry& entry) {
  const PlaneLandmark& landmark = map_.planes()[entry.id];
  const FactorForm form = options_.observation.form;
  // Pictures that follow each other err alike.
  const double s = options_.observation.sigma *
                   std::sqrt(double(landmark.observations.size()) / landmark.independent);
  for (const PlaneObservation& o : landmark.observations) {
    const PlaneMeasurement measurement =
        PlaneMeasurement::isotropic(o.normal, o.centroid, s * o.sigma_angle, s * o.sigma_offset);
    if (o.keyframe == landmark.reference) {
      add(std::make_unique<ReferencePlaneObservationFactor>(form, measurement), losses_[0].get(),
          {entry.values.data()});
    } else {
      add(std::make_unique<PlaneObservationFactor>(form, measurement), losses_[0].get(),
          {poses_->at(landmark.reference), poses_->at(o.keyframe), entry.values.data()});
    }
  }
}

void PlaneBlocks::add_points(Entry& entry) {
  const PlaneLandmark& landmark = map_.planes()[entry.id];
  double* reference = poses_->at(landmark.reference);
  // How far from flat, by many points; where they are few a plane may be young, and not one.
  const double usual = std::max(options_.point_on_plane.sigma, landmark.roughness);
  const double own = std::max(kFlattest, landmark.roughness);
  const double n = double(std::count_if(landmark.points.begin(), landmark.points.end(),
                                        [&](PointId p) { return !map_.points()[p].assumed; }));
  const double flat =
      std::sqrt((n * own * own + kPointsToBeSure * usual * usual) / (n + kPointsToBeSure));
  std::vector<PointId> outside;
  const auto add_point = [&](PointId id, double* position) {
    const double sigma = (map_.points()[id].assumed ? usual : flat) * map_.viewing_distance(id);
    add(std::make_unique<TwoRows<PointOnPlaneFactor>>(sigma), losses_[1].get(),
        {reference, entry.values.data(), position});
  };
  for (const PointId id : landmark.points) {
    if (double* position = point_of_(id)) {
      add_point(id, position);
    } else {
      outside.push_back(id);
    }
  }
  const std::size_t held = std::min(outside.size(), kMaxHeldPoints);
  for (std::size_t i = 0; i < held; ++i) {
    const PointId id = outside[i * outside.size() / held];
    add_point(id, held_point(id));
  }
}

void PlaneBlocks::add_relations() {
  for (const RelatedPlanes& r : map_.relations()) {
    Entry* a = find(r.a);
    Entry* b = find(r.b);
    if (!options_of(r.relation).use || a == nullptr || b == nullptr) continue;
    const KeyframeId ra = map_.planes()[r.a].reference, rb = map_.planes()[r.b].reference;
    std::vector<double*> blocks = {a->values.data(), b->values.data()};
    if (ra != rb) blocks = {poses_->at(ra), a->values.data(), poses_->at(rb), b->values.data()};
    add(factor_of(r), losses_[0].get(), blocks);
  }
}

const FactorOptions& PlaneBlocks::options_of(PlaneRelation relation) const {
  switch (relation) {
    case PlaneRelation::kParallel:
      return options_.parallel;
    case PlaneRelation::kPerpendicular:
      return options_.perpendicular;
    case PlaneRelation::kCoplanar:
      break;
  }
  return options_.coplanar;
}

std::unique_ptr<ceres::CostFunction> PlaneBlocks::factor_of(const RelatedPlanes& related) const {
  const PlaneLandmark& a = map_.planes()[related.a];
  const PlaneLandmark& b = map_.planes()[related.b];
  const PlaneFrames frames = a.reference == b.reference ? PlaneFrames::kOne : PlaneFrames::kTwo;
  const FactorOptions& options = options_of(related.relation);
  if (related.relation == PlaneRelation::kParallel) {
    return std::make_unique<ParallelPlanesFactor>(options.form, frames, options.sigma * kRadians);
  }
  if (related.relation == PlaneRelation::kPerpendicular) {
    return std::make_unique<PerpendicularPlanesFactor>(frames, options.sigma * kRadians);
  }
  // They meet where the second comes nearest to what is known of the first, which is the less sure
  // the farther that is.
  const Eigen::Vector3d from = map_.keyframes()[b.reference].T_wc.inverse() *
                               (map_.keyframes()[a.reference].T_wc * middle_of(a.outline));
  Eigen::Vector3d place = middle_of(b.outline);
  for (const Eigen::Vector3d& corner : b.outline) {
    if ((corner - from).norm() < (place - from).norm()) place = corner;
  }
  const double distance = std::min(viewing_distance(a), viewing_distance(b));
  return std::make_unique<CoplanarPlanesFactor>(
      frames, place, std::hypot(options.sigma * distance, a.sigma_tilt * (place - from).norm()));
}

double* PlaneBlocks::held_point(PointId id) {
  double* block = held_points_.emplace_back(map_.points()[id].position).data();
  problem_->AddParameterBlock(block, 3);
  problem_->SetParameterBlockConstant(block);
  ordering_->AddElementToGroup(block, kHeldPointGroup);
  return block;
}

double* PlaneBlocks::block_of(PlaneId id) {
  Entry* entry = find(id);
  return entry == nullptr ? nullptr : entry->values.data();
}

PlaneBlocks::Entry* PlaneBlocks::find(PlaneId id) {
  for (Entry& entry : planes_) {
    if (entry.id == id) return &entry;
  }
  return nullptr;
}

void PlaneBlocks::add(std::unique_ptr<ceres::CostFunction> factor, ceres::LossFunction* loss,
                      const std::vector<double*>& blocks) {
  problem_->AddResidualBlock(factor.get(), loss, blocks);
  factors_.push_back(std::move(factor));
}

void PlaneBlocks::scale(double factor) {
  for (Entry& entry : planes_) {
    const Plane scaled = Plane(Eigen::Vector4d::Map(entry.values.data())).scaled(factor);
    Eigen::Vector4d::Map(entry.values.data()) = scaled.coefficients();
  }
}

void PlaneBlocks::write_back(Map& map) const {
  for (const Entry& entry : planes_) {
    map.planes()[entry.id].plane = Plane(Eigen::Vector4d::Map(entry.values.data()));
  }
}

}  // namespace cairn
