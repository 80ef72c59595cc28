#include "cairn/optimization/point_losses.h"

#include <algorithm>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr std::size_t kEnough = 200;  // sightings, to tell how exact they are
constexpr double kMost = 3;           // times as exact as others, or as inexact
constexpr double kLeast = 0.001;      // σ; what fits without error is not infinitely exact

// From where a keyframe saw a point to where the map has it, in σ.
double misfit(const Map& map, const MapPoint& point, const Observation& o) {
  const int octave = map.keyframes()[o.keyframe].frame->octave(o.keypoint);
  return map.reprojection_error(o.keyframe, o.keypoint, point.position).norm() /
         map.view().sigma(octave, true);
}

}  // namespace

void PointLosses::weigh_landmarks(const Map& map) {
  group_of_slot_.clear();
  std::uint16_t groups = 1;  // the first: of none
  const auto add_group = [&](const std::vector<PointId>& points) {
    for (const PointId p : points) {
      if (!map.points().contains(p)) continue;
      if (p.slot >= group_of_slot_.size()) group_of_slot_.resize(p.slot + 1, 0);
      group_of_slot_[p.slot] = groups;
    }
    ++groups;
  };
  map.planes().for_each([&](PlaneId, const PlaneLandmark& plane) {
    if (plane.confirmed) add_group(plane.points);
  });
  map.objects().for_each([&](ObjectId, const ObjectLandmark& object) {
    if (object.born) add_group(object.points);
  });
  if (groups == 1) return;  // nothing to weigh against the others
  std::vector<std::vector<double>> misfits(groups);
  map.points().for_each([&](PointId id, const MapPoint& point) {
    if (id.slot >= group_of_slot_.size()) group_of_slot_.resize(id.slot + 1, 0);
    for (const Observation& o : point.observations) {
      if (o.aligned()) misfits[group_of_slot_[id.slot]].push_back(misfit(map, point, o));
    }
  });
  of_groups_.clear();
  of_groups_.resize(groups);
  if (misfits[0].size() < kEnough) return;
  const double usual = median(misfits[0]);
  for (std::size_t g = 1; g < groups; ++g) {
    if (misfits[g].size() < kEnough) continue;
    const double ratio = (usual + kLeast) / (median(misfits[g]) + kLeast);
    const double exact = std::clamp(ratio, 1 / kMost, kMost);
    of_groups_[g] =
        std::make_unique<ceres::ScaledLoss>(&usual_, exact * exact, ceres::DO_NOT_TAKE_OWNERSHIP);
  }
}

ceres::LossFunction* PointLosses::of(PointId point, bool aligned) {
  if (!aligned || point.slot >= group_of_slot_.size()) return &usual_;
  ceres::LossFunction* const loss = of_groups_[group_of_slot_[point.slot]].get();
  return loss == nullptr ? &usual_ : loss;
}

}  // namespace cairn
