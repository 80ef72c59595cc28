#include "cairn/mapping/plane_mapping.h"

#include <spdlog/spdlog.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/geometry/median.h"

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kGate = 3;              // σ
constexpr double kMaxStretch = 2.5;      // depth of a point on a plane over that of its centroid
constexpr double kMinTiltSigma = 0.017;  // a degree: walls are no better
// Planes farther from parallel or perpendicular are something else, however little is known of
// them.
constexpr double kMaxRelationAngle = 8 * kRadians;

// Points of the map in the mask of a plane, in the keyframe's frame.
std::vector<Eigen::Vector3d> points_in(const Map& map, const Keyframe& keyframe,
                                       const SeenPlane& seen) {
  const SE3 T_kw = keyframe.T_wc.inverse();
  std::vector<Eigen::Vector3d> points;
  for (const std::uint32_t i : seen.keypoints) {
    if (!keyframe.points[i].valid() || map.points()[keyframe.points[i]].assumed) continue;
    points.push_back(T_kw * map.points()[keyframe.points[i]].position);
  }
  return points;
}

// Points in the mask that lie on the plane become its; its own that have moved off it leave.
void gather_points(Map& map, const Keyframe& keyframe, const SeenPlane& seen, PlaneId id,
                   double point_sigma) {
  const Plane plane = map.plane_in_world(id);
  const auto lies_on = [&](PointId p) {
    const Eigen::Vector3d& x = map.points()[p].position;
    const double distance = (x - keyframe.T_wc.translation()).norm();
    return std::abs(plane.signed_distance(x)) < kGate * point_sigma * distance;
  };
  for (const std::uint32_t i : seen.keypoints) {
    const PointId p = keyframe.points[i];
    if (p.valid() && !map.points()[p].plane.valid() && lies_on(p)) map.set_plane_of(p, id);
  }
  for (const std::uint32_t i : seen.keypoints) {
    const PointId p = keyframe.points[i];
    if (p.valid() && map.points()[p].plane == id && !lies_on(p)) map.set_plane_of(p, {});
  }
}

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

// From where a landmark is seen to its middle.
double viewing_distance(const Map& map, PlaneId id) {
  return middle_of(map.planes()[id].outline).norm();  // outlines are in the reference's frame
}

void fuse_planes(Map& map, const PlaneAssociationOptions& options) {
  std::vector<PlaneId> ids;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark&) { ids.push_back(id); });
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t k = i + 1; k < ids.size(); ++k) {
      if (!map.planes().contains(ids[i]) || !map.planes().contains(ids[k])) continue;
      const double distance =
          std::min(viewing_distance(map, ids[i]), viewing_distance(map, ids[k]));
      if (!one_surface(map, ids[i], ids[k], distance, options)) continue;
      // The better known one stays.
      const bool first = map.planes()[ids[i]].sightings >= map.planes()[ids[k]].sightings;
      spdlog::debug("planes: {} ({}) and {} ({}) are one surface", int(ids[i].slot),
                    map.planes()[ids[i]].label(), int(ids[k].slot), map.planes()[ids[k]].label());
      map.merge_planes(first ? ids[k] : ids[i], first ? ids[i] : ids[k]);
    }
  }
}

double spread(const Map& map, PlaneId id) {
  const Plane plane = map.plane_in_world(id);
  std::vector<double> off;
  for (const PointId p : map.planes()[id].points) {
    const MapPoint& point = map.points()[p];
    if (point.assumed) continue;
    off.push_back(std::abs(plane.signed_distance(point.position)) / map.viewing_distance(p));
  }
  return off.empty() ? 1 : robust_sigma(off);
}

bool confirmed(const Map& map, PlaneId id, const PlaneMappingOptions& options) {
  const PlaneLandmark& landmark = map.planes()[id];
  const auto measured = std::count_if(landmark.points.begin(), landmark.points.end(),
                                      [&](PointId p) { return !map.points()[p].assumed; });
  return static_cast<int>(landmark.sightings) >= options.min_sightings &&
         static_cast<int>(measured) >= options.min_points &&
         landmark.sigma_tilt <= options.max_tilt_sigma_deg * kRadians &&
         landmark.spread <= options.max_spread;
}

void cull_planes(Map& map, std::uint32_t now, const PlaneMappingOptions& options) {
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    const bool late = now > landmark.last_seen + std::uint32_t(options.probation);
    if (late && !confirmed(map, id, options)) map.erase_plane(id);
  });
}

void update_evidence(Map& map, const PlaneMappingOptions& options) {
  map.planes().for_each([&](PlaneId id, PlaneLandmark& landmark) {
    landmark.sigma_tilt = tilt_sigma(map, id, options);
    landmark.spread = spread(map, id);
    landmark.confirmed = confirmed(map, id, options);
  });
}

// A relation begins where the angle is within two σ of it, and ends beyond three.
void relate_planes(Map& map, const PlaneMappingOptions& options) {
  struct Sure {
    PlaneId id;
    Eigen::Vector3d normal;
    double sigma;
  };
  std::vector<Sure> planes;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!confirmed(map, id, options)) return;
    planes.push_back({id, map.plane_in_world(id).normal(), landmark.sigma_tilt});
  });
  const std::vector<RelatedPlanes> before = std::move(map.relations());
  map.relations().clear();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      const double cosine = std::min(std::abs(planes[i].normal.dot(planes[k].normal)), 1.0);
      const double sigma = std::hypot(planes[i].sigma, planes[k].sigma);
      for (const auto relation : {PlaneRelation::kParallel, PlaneRelation::kPerpendicular}) {
        const double off =
            relation == PlaneRelation::kParallel ? std::acos(cosine) : std::asin(cosine);
        const bool held = std::any_of(before.begin(), before.end(), [&](const RelatedPlanes& r) {
          return r.a == planes[i].id && r.b == planes[k].id && r.relation == relation;
        });
        if (off < std::min((held ? 3 : 2) * sigma, kMaxRelationAngle)) {
          map.relations().push_back({planes[i].id, planes[k].id, relation});
          break;
        }
      }
    }
  }
}

}  // namespace

int refine_plane(SeenPlane& seen, std::span<const Eigen::Vector3d> points, double sigma) {
  // Unknowns: turns of the normal about two axes of the plane, and a shift along it, at the
  // predicted centroid.
  const Eigen::Vector3d n0 = seen.plane.normal(), c = seen.centroid;
  const Eigen::Vector3d u = n0.unitOrthogonal(), v = n0.cross(u);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  // n = n0 + x0 u + x1 v, shift x2
  const Eigen::Vector3d prior(1 / seen.sigma_angle, 1 / seen.sigma_angle, 1 / seen.sigma_offset);
  const auto row = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(u.dot(p - c), v.dot(p - c), -1);
  };
  // From a loss as wide as the prediction is unsure down to that of the points: so points of other
  // things, that are nearer to the prediction, do not catch it.
  double width = std::max(seen.sigma_offset, sigma);
  Eigen::Matrix3d H;
  while (true) {
    for (int iteration = 0; iteration < 3; ++iteration) {
      H = prior.cwiseAbs2().asDiagonal();
      Eigen::Vector3d g = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d J = row(p);
        const double distance = n0.dot(p - c) + J.dot(x);
        const double weight = 1 / (1 + std::pow(distance / width, 2)) / (sigma * sigma);  // Cauchy
        H += weight * J * J.transpose();
        g += weight * n0.dot(p - c) * J;
      }
      x = H.ldlt().solve(-g);
    }
    if (width <= sigma) break;
    width = std::max(width / 2, sigma);
  }
  if (!x.allFinite()) return 0;
  const Eigen::Vector3d n = (n0 + x[0] * u + x[1] * v).normalized();
  const Eigen::Vector3d on_it = c + x[2] * n0;
  const Plane refined = Plane::through(on_it, n);
  const auto count = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return std::abs(refined.signed_distance(p)) < kGate * sigma;
  });
  seen.plane = refined;
  seen.centroid = c - refined.signed_distance(c) * n;
  for (Eigen::Vector3d& corner : seen.outline) corner -= refined.signed_distance(corner) * n;
  const Eigen::Matrix3d covariance = H.inverse();
  seen.sigma_angle =
      std::hypot(kMinTiltSigma, std::sqrt(std::max(covariance(0, 0), covariance(1, 1))));
  seen.sigma_offset = std::hypot(sigma, std::sqrt(covariance(2, 2)));
  return static_cast<int>(count);
}

double tilt_sigma(const Map& map, PlaneId id, const PlaneMappingOptions& options) {
  const PlaneLandmark& landmark = map.planes()[id];
  // What a tilt about an axis in the plane would cost: the points far from the axis tell.
  const Eigen::Vector3d n = map.plane_in_world(id).normal();
  const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
  const Eigen::Vector3d eye = map.keyframes()[landmark.reference].T_wc.translation();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double distances = 0;
  double count = 0;
  for (const PointId p : landmark.points) {
    if (map.points()[p].assumed) continue;
    const Eigen::Vector3d& x = map.points()[p].position;
    mean += Eigen::Vector2d(u.dot(x), v.dot(x));
    distances += (x - eye).norm();
    ++count;
  }
  if (count > 0) {
    mean /= count;
    const double sigma = options.association.point_sigma * distances / count;
    for (const PointId p : landmark.points) {
      if (map.points()[p].assumed) continue;
      const Eigen::Vector3d& x = map.points()[p].position;
      const Eigen::Vector2d off = Eigen::Vector2d(u.dot(x), v.dot(x)) - mean;
      information += off * off.transpose() / (sigma * sigma);
    }
  }
  // Pictures of one network err alike: together they count as one.
  double best = 0;
  for (const PlaneObservation& o : landmark.observations) {
    best = std::max(best, 1 / (o.sigma_angle * o.sigma_angle));
  }
  information.diagonal().array() += best;
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(information, Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
  return least > 0 ? std::hypot(kMinTiltSigma, 1 / std::sqrt(least)) : std::numbers::pi;
}

std::vector<PointId> map_planes(Map& map, KeyframeId id, const KeyframePerception& seen,
                                const DepthScale& scale, const PlaneMappingOptions& options) {
  const Keyframe& keyframe = map.keyframes()[id];
  update_evidence(map, options);  // the map has been adjusted
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
    refine_plane(planes.back(), points_in(map, keyframe, planes.back()),
                 options.association.point_sigma * planes.back().centroid.norm());
  }
  const bool poor = measured_points(map, keyframe) < options.few_points;
  std::vector<PointId> created;
  const std::vector<PlaneDecision> decisions =
      associate_planes(map, id, planes, options.association);
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
    gather_points(map, keyframe, planes[i], plane, options.association.point_sigma);
    if (poor) assume_points_on(map, id, planes[i], plane, created);
  }
  for (std::uint32_t i = 0; poor && i < keyframe.points.size(); ++i) {
    if (keyframe.points[i].valid() || !(seen.depth[i] > 0)) continue;
    created.push_back(assume_point(map, id, i, scale.here * seen.depth[i]));
  }
  update_evidence(map, options);
  fuse_planes(map, options.association);
  cull_planes(map, keyframe.sequence, options);
  if (options.manhattan) relate_planes(map, options);
  std::erase_if(created, [&](PointId p) { return !map.points().contains(p); });
  return created;
}

void remove_unconfirmed_planes(Map& map, const PlaneMappingOptions& options) {
  update_evidence(map, options);
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    spdlog::debug("plane {} ({}): {} pictures, {} points, spread {:.4f}, tilt {:.1f} deg: {}",
                  int(id.slot), landmark.label(), landmark.sightings, landmark.points.size(),
                  landmark.spread, landmark.sigma_tilt / kRadians,
                  landmark.confirmed ? "kept" : "refused");
    if (!landmark.confirmed) map.erase_plane(id);
  });
}

}  // namespace cairn
