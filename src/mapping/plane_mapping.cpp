#include "cairn/mapping/plane_mapping.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "cairn/mapping/plane_confirmation.h"
#include "cairn/mapping/plane_refinement.h"
#include "cairn/mapping/plane_relations.h"

namespace cairn {
namespace {

constexpr double kMaxStretch = 2.5;  // depth of a point on a plane over that of its centroid
constexpr double kHalfway = 45;      // degrees, to a surface that stands square to it

int measured_points(const Map& map, const Keyframe& keyframe) {
  return static_cast<int>(
      std::count_if(keyframe.points.begin(), keyframe.points.end(), [&](PointId p) {
        return p.valid() && !map.points()[p].assumed && map.points()[p].observations.size() > 1;
      }));
}

// A camera that turns sees what no second view has measured yet: where a plane or the predicted
// depth says how far a keypoint is, it becomes a point of the map.
PointId assume_point(Map& map, KeyframeId id, std::uint32_t keypoint, double depth) {
  const Keyframe& keyframe = map.keyframes()[id];
  const Eigen::Vector3d ray = map.view().pinhole().unproject(keyframe.frame->pixel(keypoint));
  const PointId p = map.add_point(keyframe.T_wc * (depth * ray));
  map.add_observation(p, id, keypoint);
  MapPoint& point = map.points()[p];
  point.assumed = true;
  point.colour = keyframe.frame->features.keypoints[keypoint].colour;
  point.born = keyframe.sequence;
  map.update_descriptor(p);
  map.update_geometry(p);
  return p;
}

void assume_points_on(Map& map, KeyframeId id, const SeenPlane& seen, PlaneId plane,
                      std::vector<PointId>& created) {
  const Keyframe& keyframe = map.keyframes()[id];
  const Plane in_camera = map.plane_in_world(plane).transformed(keyframe.T_wc.inverse());
  for (const std::uint32_t i : seen.keypoints) {
    if (keyframe.points[i].valid()) continue;
    const auto depth =
        in_camera.depth_along(map.view().pinhole().unproject(keyframe.frame->pixel(i)));
    if (!depth || *depth > kMaxStretch * seen.centroid.z()) continue;
    created.push_back(assume_point(map, id, i, *depth));
    map.set_plane_of(created.back(), plane);
  }
}

// Where points are few, normals are as the detector gives them, and points get their depth from
// planes: rather the wall that is known than a new one that stands askew.
PlaneAssociationOptions for_picture(const PlaneAssociationOptions& options, bool poor) {
  PlaneAssociationOptions result = options;
  if (poor) result.max_angle_deg = std::max(result.max_angle_deg, kHalfway);
  return result;
}

}  // namespace

std::vector<PointId> map_planes(Map& map, KeyframeId id, const KeyframePerception& seen,
                                const DepthScale& scale, const PlaneMappingOptions& options) {
  const Keyframe& keyframe = map.keyframes()[id];
  judge_planes(map, options);  // the map has been adjusted
  std::vector<SeenPlane> planes, raw;
  const auto in_units = [](const SeenPlane& plane, double units, double sigma) {
    SeenPlane result = plane.scaled(units);
    result.sigma_offset = std::max(result.sigma_offset, sigma * result.centroid.norm());
    return result;
  };
  for (const SeenPlane& plane : seen.planes) {
    // What pictures say of lengths is what all of them say: so planes hold the unit of the map.
    raw.push_back(
        in_units(plane, scale.everywhere, std::hypot(scale.sigma_here, scale.sigma_everywhere)));
    planes.push_back(in_units(plane, scale.here, scale.sigma_here));
    refine_plane(planes.back(),
                 plane_points(map, keyframe, plane.inner, options.association.point_sigma),
                 options.association.point_sigma);
  }
  const bool poor = measured_points(map, keyframe) < options.few_points;
  std::vector<PointId> created;
  const PlaneAssociationOptions association = for_picture(options.association, poor);
  const std::vector<PlaneDecision> decisions = associate_planes(map, id, planes, association);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    PlaneId plane = decisions[i].plane;
    if (decisions[i].kind == PlaneDecision::Kind::kUnclear) continue;
    if (decisions[i].kind == PlaneDecision::Kind::kNew) {
      plane = map.add_plane(id, planes[i]);
      // The factor is of what the network said; the points have factors of their own.
      PlaneObservation& first = map.planes()[plane].observations.front();
      first.normal = raw[i].plane.facing_origin().normal();
      first.centroid = raw[i].centroid;
      first.sigma_angle = raw[i].sigma_angle;
      first.sigma_offset = raw[i].sigma_offset;
    } else {
      map.observe_plane(plane, id, raw[i]);
    }
    if (poor) assume_points_on(map, id, planes[i], plane, created);
  }
  for (std::uint32_t i = 0; poor && i < keyframe.frame->corners(); ++i) {
    if (keyframe.points[i].valid() || !(seen.depth[i] > 0)) continue;
    created.push_back(assume_point(
        map, id, i, scale.here * stretched_depth(seen.depth[i], seen.range, map.depth_contrast)));
  }
  judge_planes(map, options);
  fuse_planes(map, association);
  cull_planes(map, keyframe.timestamp(), options);
  if (options.manhattan) relate_planes(map, options);
  std::erase_if(created, [&](PointId p) { return !map.points().contains(p); });
  return created;
}

void fuse_planes(Map& map, const PlaneAssociationOptions& options) {
  std::vector<PlaneId> ids;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark&) { ids.push_back(id); });
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      if (!map.planes().contains(ids[i]) || !map.planes().contains(ids[k])) continue;
      const double distance =
          std::min(viewing_distance(map.planes()[ids[i]]), viewing_distance(map.planes()[ids[k]]));
      if (!one_surface(map, ids[i], ids[k], distance, options)) continue;
      // The better known one stays.
      const bool first = map.planes()[ids[i]].sightings >= map.planes()[ids[k]].sightings;
      spdlog::debug("planes: {} ({}) and {} ({}) are one surface", int(ids[i].slot),
                    map.planes()[ids[i]].label(), int(ids[k].slot), map.planes()[ids[k]].label());
      map.merge_planes(first ? ids[k] : ids[i], first ? ids[i] : ids[k]);
    }
  }
}

}  // namespace cairn
