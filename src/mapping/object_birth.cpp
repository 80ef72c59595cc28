#include "cairn/mapping/object_birth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/geometry/median.h"
#include "cairn/map/object_classes.h"
#include "cairn/optimization/object_blocks.h"

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMiddle = 0.6;  // of a box, in which what is seen is mostly the thing itself
constexpr std::size_t kFewPoints = 3;
constexpr double kFarTooLarge = 3;  // σ of the class's size

// Depths of what the middle of a box shows.
std::vector<double> depths_in(const Map& map, const Keyframe& keyframe, const SeenObject& seen,
                              bool predicted) {
  const Eigen::Vector2d centre = seen.box.centre();
  const SE3 T_cw = keyframe.T_wc.inverse();
  std::vector<double> depths;
  for (const std::uint32_t i : seen.keypoints) {
    const Eigen::Vector2d off = keyframe.frame->pixel(i) - centre;
    if (std::abs(off.x()) > kMiddle * seen.box.width() / 2 ||
        std::abs(off.y()) > kMiddle * seen.box.height() / 2) {
      continue;
    }
    if (predicted) {
      if (!keyframe.depth.empty() && keyframe.depth[i] > 0) {
        depths.push_back(map.units_a_metre * stretched_depth(keyframe.depth[i],
                                                             keyframe.depth_range,
                                                             map.depth_contrast));
      }
    } else if (const MapPoint* p = map.points().find(keyframe.points[i]); p && !p->assumed) {
      depths.push_back((T_cw * p->position).z());
    }
  }
  return depths;
}

double depth_of(const Map& map, const Keyframe& keyframe, const SeenObject& seen) {
  std::vector<double> depths = depths_in(map, keyframe, seen, false);
  if (depths.size() >= kFewPoints) return median(depths);
  if (map.units_a_metre > 0) {
    depths = depths_in(map, keyframe, seen, true);
    if (depths.size() >= kFewPoints) return median(depths);
    const double size = usual_size(seen.class_name) * map.units_a_metre;
    const double pixels = std::sqrt(seen.box.width() * seen.box.height()) / 2;
    const bool whole = std::none_of(seen.cut.begin(), seen.cut.end(), [](bool c) { return c; });
    if (size > 0 && whole) return size * map.view().pinhole().fx / pixels;
  }
  depths.clear();
  for (const PointId p : keyframe.points) {
    if (const MapPoint* point = map.points().find(p)) {
      depths.push_back((keyframe.T_wc.inverse() * point->position).z());
    }
  }
  return depths.empty() ? 1 : median(depths);
}

}  // namespace

Ellipsoid guess_ellipsoid(const Map& map, const Keyframe& keyframe, const SeenObject& seen) {
  const Pinhole& pinhole = map.view().pinhole();
  const double depth = std::max(depth_of(map, keyframe, seen), 1e-6);
  const double a = seen.box.width() / 2 * depth / pinhole.fx;
  const double b = seen.box.height() / 2 * depth / pinhole.fy;
  const double c = std::sqrt(a * b);
  // What is seen of it is its near side.
  const Eigen::Vector3d centre =
      (1 + 0.5 * c / depth) * depth * pinhole.unproject(seen.box.centre());
  return {SE3(Eigen::Quaterniond::Identity(), centre), {a, b, c}};
}

ObjectFit fit_to_boxes(const Map& map, const ObjectLandmark& landmark) {
  std::vector<BoxView> views;
  const SE3 T_wr = map.keyframes()[landmark.reference].T_wc;
  // Pictures that follow each other err alike.
  const double worth = landmark.independent / double(landmark.observations.size());
  for (const ObjectObservation& o : landmark.observations) {
    const SE3 T_cr = map.camera_of(o).inverse() * T_wr;
    views.push_back({T_cr, o.box, o.cut, o.sigma, worth * o.score});
  }
  return fit_object(landmark.ellipsoid, views, map.view().pinhole(),
                    prior_of(landmark.class_name(), map.units_a_metre));
}

double viewing_span(const Map& map, const ObjectLandmark& landmark) {
  const SE3 T_rw = map.keyframes()[landmark.reference].T_wc.inverse();
  std::vector<Eigen::Vector3d> directions;
  for (const ObjectObservation& o : landmark.observations) {
    const Eigen::Vector3d eye = T_rw * map.camera_of(o).translation();
    directions.push_back((eye - landmark.ellipsoid.centre()).normalized());
  }
  double least = 1;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) least = std::min(least, directions[i].dot(directions[k]));
  }
  return std::acos(std::clamp(least, -1.0, 1.0));
}

std::string refusal(const Map& map, const ObjectLandmark& landmark, const ObjectFit& fit,
                    const ObjectBirthOptions& options) {
  if (fit.views < options.min_views) return "too few views";
  if (viewing_span(map, landmark) < options.min_span_deg * kRadians) return "too little parallax";
  if (!fit.usable) return "no fit";
  if (fit.agreeing < options.min_agreeing * fit.views) return "boxes disagree";
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> place(fit.covariance.topLeftCorner<3, 3>());
  double distance = 0;
  const SE3 T_rw = map.keyframes()[landmark.reference].T_wc.inverse();
  for (const ObjectObservation& o : landmark.observations) {
    const Eigen::Vector3d eye = T_rw * map.camera_of(o).translation();
    distance += (eye - fit.ellipsoid.centre()).norm() / double(landmark.observations.size());
  }
  if (!(std::sqrt(place.eigenvalues()[2]) < options.max_sigma_place * distance)) {
    return "place unsure";
  }
  const double sigma_size = std::sqrt(fit.covariance.bottomRightCorner<3, 3>().sum()) / 3;
  if (!(sigma_size < options.max_sigma_size)) return "size unsure";
  const double usual = usual_size(landmark.class_name()) * map.units_a_metre;
  if (usual > 0) {
    const double off = std::log(std::cbrt(fit.ellipsoid.semi_axes.prod()) / usual);
    const double sigma = std::hypot(find_object_class(landmark.class_name())->sigma, 0.3);
    if (std::abs(off) > kFarTooLarge * sigma) return "not of its class's size";
  }
  return "";
}

void accept(ObjectLandmark& landmark, const ObjectFit& fit) {
  landmark.ellipsoid = fit.ellipsoid;
  const Eigen::Matrix3d R = fit.ellipsoid.T.matrix3();
  landmark.covariance = R * fit.covariance.topLeftCorner<3, 3>() * R.transpose();
}

}  // namespace cairn
