#include "cairn/optimization/object_blocks.h"

#include <algorithm>
#include <cmath>

#include "cairn/optimization/factors/object_observation_factor.h"
#include "cairn/optimization/factors/object_size_factor.h"
#include "cairn/optimization/factors/object_turn_factor.h"
#include "cairn/optimization/factors/support_factor.h"
#include "cairn/optimization/object_prior.h"

namespace cairn {
namespace {

constexpr std::size_t kMinObservations = 2;  // of an object, that it takes part
constexpr double kSigmaIou = 0.1;            // paper form: where a box's edge has its own σ
constexpr double kSigmaTurn = 0.1;           // radians: from one adjustment to the next

}  // namespace

void ObjectBlocks::add_to(ceres::Problem& problem, ceres::ParameterBlockOrdering& ordering,
                          PoseBlocks& poses, PlaneBlocks& planes) {
  problem_ = &problem;
  poses_ = &poses;
  box_loss_ = std::make_unique<ceres::CauchyLoss>(kObjectLoss);
  support_loss_ = std::make_unique<ceres::CauchyLoss>(1.0);
  objects_.reserve(map_.objects().size());
  map_.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    if (!takes_part(landmark)) return;
    Entry& entry = objects_.emplace_back();
    entry.id = id;
    ObjectManifold::pack(landmark.ellipsoid, entry.values.data());
    problem.AddParameterBlock(entry.values.data(), ObjectManifold::kAmbient, &manifold_);
    ordering.AddElementToGroup(entry.values.data(), kObjectGroup);
  });
  for (Entry& entry : objects_) {
    add_observations(entry);
    add_prior(entry);
    if (options_.support.use && map_.units_a_true_metre() > 0) add_support(entry, planes);
  }
}

// Without boxes nothing else says where an object is.
bool ObjectBlocks::takes_part(const ObjectLandmark& landmark) const {
  if (!options_.observation.use || !landmark.born) return false;
  const auto& observations = landmark.observations;
  return observations.size() >= kMinObservations &&
         std::any_of(observations.begin(), observations.end(), [&](const ObjectObservation& o) {
           return poses_->own(o.keyframe) != nullptr;
         });
}

void ObjectBlocks::add_observations(Entry& entry) {
  const ObjectLandmark& landmark = map_.objects()[entry.id];
  const FactorForm form = options_.observation.form;
  // Pictures that follow each other err alike; what is an outlier stays one.
  box_losses_.emplace_back(box_loss_.get(),
                           landmark.independent / double(landmark.observations.size()),
                           ceres::DO_NOT_TAKE_OWNERSHIP);
  ceres::LossFunction* loss = &box_losses_.back();
  const double s = options_.observation.sigma;
  for (const ObjectObservation& o : landmark.observations) {
    const ObjectMeasurement measurement{map_.view().pinhole(), o.box,   o.cut, s * o.sigma,
                                        s * kSigmaIou,         o.score, o.T_kc};
    if (o.keyframe == landmark.reference) {
      add(std::make_unique<ReferenceObjectObservationFactor>(form, measurement), loss,
          {entry.values.data()});
    } else {
      add(std::make_unique<ObjectObservationFactor>(form, measurement), loss,
          {poses_->at(landmark.reference), poses_->at(o.keyframe), entry.values.data()});
    }
  }
}

// Every object is held as it is turned, loosely: see ObjectTurnFactor.
void ObjectBlocks::add_prior(Entry& entry) {
  const ObjectLandmark& landmark = map_.objects()[entry.id];
  const ObjectClass* known = find_object_class(landmark.class_name());
  const bool paper = options_.size.form == FactorForm::kPaper;
  ObjectPrior prior;
  if (landmark.likeness != Likeness::kNothing) {
    prior = prior_of(landmark.class_name(), map_.units_a_true_metre());
  }
  prior.turn = landmark.ellipsoid.T.rotation();
  if (landmark.likeness != Likeness::kSize && map_.up) {
    const SE3& T_wr = map_.keyframes()[landmark.reference].T_wc;
    expect_upright(prior, prior.turn,
                   {T_wr.rotation().conjugate() * map_.up->direction, map_.up->sigma});
  }
  if (landmark.likeness == Likeness::kSizeAndShape && known != nullptr) {
    expect_shape(prior, *known);
  } else if (paper && known != nullptr) {
    prior.shape = class_shape(*known);
  }
  prior.sigma_turn = prior.sigma_turn.cwiseMin(kSigmaTurn);
  add(std::make_unique<ObjectTurnFactor>(prior), nullptr, {entry.values.data()});
  if (!options_.size.use) return;
  prior.sigma_size *= options_.size.sigma;
  prior.sigma_shape *= options_.size.sigma;
  add(std::make_unique<ObjectSizeFactor>(options_.size.form, prior), nullptr,
      {entry.values.data()});
}

void ObjectBlocks::add_support(Entry& entry, PlaneBlocks& planes) {
  const ObjectLandmark& landmark = map_.objects()[entry.id];
  double* plane = planes.block_of(landmark.support);
  if (plane == nullptr) return;
  const KeyframeId reference = landmark.reference;
  const KeyframeId plane_reference = map_.planes()[landmark.support].reference;
  const Eigen::Vector3d centre = map_.keyframes()[reference].T_wc * landmark.ellipsoid.centre();
  const double side = map_.plane_in_world(landmark.support).signed_distance(centre) < 0 ? -1 : 1;
  const SupportFrames frames =
      reference == plane_reference ? SupportFrames::kOne : SupportFrames::kTwo;
  std::vector<double*> blocks = {plane, entry.values.data()};
  if (frames == SupportFrames::kTwo) {
    blocks = {poses_->at(plane_reference), plane, poses_->at(reference), entry.values.data()};
  }
  const double sigma = options_.support.sigma * map_.units_a_true_metre();
  add(std::make_unique<SupportFactor>(options_.support.form, frames, side, sigma),
      support_loss_.get(), blocks);
}

void ObjectBlocks::add(std::unique_ptr<ceres::CostFunction> factor, ceres::LossFunction* loss,
                       const std::vector<double*>& blocks) {
  problem_->AddResidualBlock(factor.get(), loss, blocks);
  factors_.push_back(std::move(factor));
}

void ObjectBlocks::scale(double factor) {
  for (Entry& entry : objects_) {
    Ellipsoid e = ObjectManifold::unpack(entry.values.data());
    e.T = SE3(e.T.rotation(), factor * e.T.translation());
    e.semi_axes *= factor;
    ObjectManifold::pack(e, entry.values.data());
  }
}

// What ran away stays as it was.
void ObjectBlocks::write_back(Map& map) const {
  for (const Entry& entry : objects_) {
    const Ellipsoid e = ObjectManifold::unpack(entry.values.data());
    if (!e.T.is_finite() || !e.semi_axes.allFinite() || !(e.semi_axes.minCoeff() > 0)) continue;
    map.objects()[entry.id].ellipsoid = e;
  }
}

}  // namespace cairn
