#include "cairn/system/result.h"

#include <algorithm>
#include <vector>

#include "cairn/geometry/median.h"
#include "cairn/mapping/plane_shape.h"

namespace cairn {
namespace {

std::vector<int>& bound(MappedPlane& plane, PlaneRelation relation) {
  switch (relation) {
    case PlaneRelation::kParallel:
      return plane.parallel;
    case PlaneRelation::kPerpendicular:
      return plane.perpendicular;
    case PlaneRelation::kCoplanar:
      break;
  }
  return plane.coplanar;
}

}  // namespace

std::vector<MappedPlane> describe_planes(const Map& map) {
  std::vector<MappedPlane> planes;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    MappedPlane plane;
    const Plane in_world = map.plane_in_world(id);
    plane.id = static_cast<int>(id.slot);
    plane.label = landmark.label();
    plane.normal = in_world.normal();
    plane.d = in_world.offset();
    plane.outline = plane_shape(map, id);
    plane.sigma_angle = landmark.sigma_tilt;
    plane.points = static_cast<int>(landmark.points.size());
    plane.sightings = static_cast<int>(landmark.sightings);
    for (const PlaneObservation& o : landmark.observations) {
      plane.seen.push_back(map.keyframes()[o.keyframe].timestamp());
    }
    std::sort(plane.seen.begin(), plane.seen.end());
    for (const RelatedPlanes& r : map.relations()) {
      if (r.a != id && r.b != id) continue;
      const int other = static_cast<int>((r.a == id ? r.b : r.a).slot);
      bound(plane, r.relation).push_back(other);
    }
    planes.push_back(std::move(plane));
  });
  return planes;
}

std::vector<MappedObject> describe_objects(const Map& map) {
  std::vector<MappedObject> objects;
  map.objects().for_each([&](ObjectId id, const ObjectLandmark& landmark) {
    const Keyframe& reference = map.keyframes()[landmark.reference];
    MappedObject object;
    object.id = static_cast<int>(id.slot);
    object.class_name = landmark.class_name();
    object.score = landmark.score();
    object.ellipsoid = map.object_in_world(id);
    object.in_reference = landmark.ellipsoid;
    object.reference_time = reference.timestamp();
    const Eigen::Matrix3d R = reference.T_wc.matrix3();
    object.covariance = R * landmark.covariance * R.transpose();
    object.points = static_cast<int>(landmark.points.size());
    object.sightings = static_cast<int>(landmark.sightings);
    for (const ObjectObservation& o : landmark.observations) object.seen.push_back(o.time);
    std::sort(object.seen.begin(), object.seen.end());
    if (map.planes().contains(landmark.support)) object.plane = int(landmark.support.slot);
    objects.push_back(std::move(object));
  });
  return objects;
}

void to_metres(SlamResult& result) {
  const double scale = result.scale.value;
  for (Trajectory* trajectory : {&result.trajectory, &result.trajectory_live, &result.keyframes}) {
    for (StampedPose& pose : *trajectory) {
      pose.T_wc = SE3(pose.T_wc.rotation(), scale * pose.T_wc.translation());
    }
  }
  for (SlamResult::Point& point : result.points) point.position *= scale;
  for (MappedPlane& plane : result.planes) {
    plane.d *= scale;
    for (Eigen::Vector3d& corner : plane.outline) corner *= scale;
  }
  for (MappedObject& object : result.objects) {
    for (Ellipsoid* e : {&object.ellipsoid, &object.in_reference}) {
      *e = {SE3(e->T.rotation(), scale * e->T.translation()), scale * e->semi_axes};
    }
    object.covariance *= scale * scale;
  }
}

ReprojectionError reprojection_error(const Map& map) {
  std::vector<double> errors;
  map.points().for_each([&](PointId, const MapPoint& point) {
    for (const Observation& o : point.observations) {
      errors.push_back(map.reprojection_error(o.keyframe, o.keypoint, point.position).norm());
    }
  });
  ReprojectionError result;
  result.observations = errors.size();
  if (errors.empty()) return result;
  result.median_px = quantile(errors, 0.5);
  result.p75_px = quantile(errors, 0.75);
  result.p95_px = quantile(errors, 0.95);
  return result;
}

}  // namespace cairn
