#include "cairn/mapping/object_birth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cairn/geometry/median.h"
#include "cairn/map/object_classes.h"
#include "cairn/mapping/points_in_box.h"
#include "cairn/optimization/object_prior.h"

namespace cairn {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMiddle = 0.6;  // of a box, in which what is seen is mostly the thing itself
constexpr std::size_t kFewPoints = 3;
constexpr double kFarTooLarge = 3;  // σ of the class's size
constexpr double kLarge = 1;        // the same: larger ones are no part of such a thing
constexpr double kFarTooSmall = 5;  // the same: of a chair behind a table only the back is seen
// In the cost: things stand as usual rather than in any way, and are what they are called.
constexpr double kUprightOdds = 8, kNamedOdds = 4;
constexpr double kSigmaGround = 0.01;  // metres, between a thing and what it stands on
constexpr double kShareOfSize = 0.65;  // of a thing's longest semi-axis, that its place may be off
constexpr double kWithPoints = 2;      // times as much, where the map's points lie there
// Of the share of boxes that a birth asks for: with as many as were asked for, the next box that is
// a little off would be the end of a thing.
constexpr double kEnoughToStay = 0.85;
constexpr double kLeastSlant = 0.1;  // of a unit vector, that its horizontal part says a direction

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
  if (map.units_a_true_metre() > 0) {
    depths = depths_in(map, keyframe, seen, true);
    if (depths.size() >= kFewPoints) return median(depths);
    const double size = prior_of(seen.class_name, map.units_a_true_metre()).usual;
    const double pixels = std::sqrt(seen.box.width() * seen.box.height()) / 2;
    if (size > 0 && !seen.is_cut()) return size * map.view().pinhole().fx / pixels;
  }
  depths.clear();
  for (const PointId p : keyframe.points) {
    if (const MapPoint* point = map.points().find(p)) {
      depths.push_back((keyframe.T_wc.inverse() * point->position).z());
    }
  }
  return depths.empty() ? 1 : median(depths);
}

// In σ; 0 where nothing is usual.
double larger_than_usual(const ObjectPrior& of_class, const Ellipsoid& thing) {
  if (!(of_class.usual > 0)) return 0;
  return std::log(std::cbrt(thing.semi_axes.prod()) / of_class.usual) / of_class.sigma_size;
}

// In the reference's frame.
std::vector<BoxView> views_of(const Map& map, const ObjectLandmark& landmark) {
  std::vector<BoxView> views;
  const SE3 T_wr = map.keyframes()[landmark.reference].T_wc;
  // Pictures that follow each other err alike.
  const double worth = landmark.independent / double(landmark.observations.size());
  for (const ObjectObservation& o : landmark.observations) {
    const SE3 T_cr = map.camera_of(o).inverse() * T_wr;
    views.push_back({T_cr, o.box, o.cut, o.sigma, worth * o.score});
  }
  return views;
}

// Which of the two horizontal axes is the longer one, only a try can tell.
ObjectFit fit_upright(const Ellipsoid& start, const Eigen::Vector3d& axes,
                      std::span<const BoxView> views, const Pinhole& pinhole, ObjectPrior prior,
                      const Upward& up) {
  Eigen::Index longest = 0;
  const double scale = start.semi_axes.maxCoeff(&longest) / axes.maxCoeff();
  Eigen::Vector3d x = start.T.matrix3().col(longest);
  x -= x.dot(up.direction) * up.direction;
  x = x.norm() > kLeastSlant ? x.normalized() : up.direction.unitOrthogonal();
  ObjectFit best;
  for (const Eigen::Vector3d& along : {x, Eigen::Vector3d(up.direction.cross(x))}) {
    Eigen::Matrix3d R;
    R << along, up.direction, along.cross(up.direction);
    const Ellipsoid turned{SE3(R, start.centre()), scale * axes};
    expect_upright(prior, turned.T.rotation(), up);
    const ObjectFit fit = fit_object(turned, views, pinhole, prior);
    if (fit.usable && (!best.usable || fit.cost < best.cost)) best = fit;
  }
  return best;
}

// Most of what the boxes show is as far away as the thing is thought to be. The boxes' own sizes
// say nothing of that, so it tells whether the fit, unsure of how far, has it right.
bool points_lie_there(const Map& map, const ObjectLandmark& landmark, const Ellipsoid& ellipsoid) {
  const Eigen::Vector3d centre = map.keyframes()[landmark.reference].T_wc * ellipsoid.centre();
  const double reach = ellipsoid.semi_axes.maxCoeff();
  std::size_t there = 0, seen = 0;
  for (const ObjectObservation& o : landmark.observations) {
    if (o.buried) continue;
    const Keyframe& keyframe = map.keyframes()[o.keyframe];
    const SE3 T_cw = keyframe.T_wc.inverse();
    const double depth = (T_cw * centre).z();
    for_each_point_in(o.box, map, keyframe, [&](const MapPoint& point) {
      if (point.assumed) return;
      ++seen;
      there += std::abs((T_cw * point.position).z() - depth) < reach;
    });
  }
  return seen >= kFewPoints && 2 * there > seen;
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

BoxFit fit_to_boxes(const Map& map, const ObjectLandmark& landmark) {
  const SE3 T_wr = map.keyframes()[landmark.reference].T_wc;
  const std::vector<BoxView> views = views_of(map, landmark);
  const Pinhole& pinhole = map.view().pinhole();
  ObjectPrior prior = prior_of(landmark.class_name(), map.units_a_true_metre());
  BoxFit best{fit_object(landmark.ellipsoid, views, pinhole, prior)};
  const ObjectClass* known = find_object_class(landmark.class_name());
  if (!map.up || known == nullptr) return best;
  const Upward up{T_wr.rotation().conjugate() * map.up->direction, map.up->sigma};
  const Ellipsoid start = best.fit.ellipsoid;
  double least = best.fit.usable ? best.fit.cost : HUGE_VAL;
  const auto consider = [&](const ObjectFit& fit, Likeness likeness, double odds) {
    if (!fit.usable || !(fit.cost - odds < least)) return;
    least = fit.cost - odds;
    best = {fit, likeness};
  };
  expect_shape(prior, *known);
  consider(fit_upright(start, Eigen::Vector3d(known->semi_axes), views, pinhole, prior, up),
           Likeness::kSizeAndShape, kUprightOdds);
  // A part of a thing, or a shadow, is not born; and no fit costs less than nothing.
  if (!landmark.born || least < kNamedOdds) return best;
  ObjectPrior unlike;
  if (map.planes().contains(landmark.support)) {
    unlike.ground = map.plane_in_world(landmark.support).transformed(T_wr.inverse());
    unlike.sigma_ground = kSigmaGround * map.units_a_true_metre();
  }
  const ObjectFit fit = fit_upright(start, Eigen::Vector3d::Ones(), views, pinhole, unlike, up);
  // What is somewhat large may be what it is called; what is far too large is not.
  const double larger = larger_than_usual(prior, fit.ellipsoid);
  if (larger < kLarge || larger > kFarTooLarge) consider(fit, Likeness::kNothing, -kNamedOdds);
  return best;
}

std::string refusal(const Map& map, const ObjectLandmark& landmark, const ObjectFit& fit,
                    const ObjectBirthOptions& options) {
  if (fit.views < options.min_views) return "too few views";
  if (!fit.usable) return "no fit";
  if (fit.span < options.min_span_deg * kRadians) return "too little parallax";
  const double agreeing = (landmark.born ? kEnoughToStay : 1) * options.min_agreeing;
  if (fit.agreeing < agreeing * fit.views) return "boxes disagree";
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> place(fit.covariance.topLeftCorner<3, 3>());
  double distance = 0;
  const SE3 T_rw = map.keyframes()[landmark.reference].T_wc.inverse();
  for (const ObjectObservation& o : landmark.observations) {
    const Eigen::Vector3d eye = T_rw * map.camera_of(o).translation();
    distance += (eye - fit.ellipsoid.centre()).norm() / double(landmark.observations.size());
  }
  const double near = std::max(options.max_sigma_place * distance,
                               kShareOfSize * fit.ellipsoid.semi_axes.maxCoeff());
  const double unsure = std::sqrt(place.eigenvalues()[2]);
  if (!(unsure < near) &&
      !(unsure < kWithPoints * near && points_lie_there(map, landmark, fit.ellipsoid))) {
    return "place unsure";
  }
  const double sigma_size = std::sqrt(fit.covariance.bottomRightCorner<3, 3>().sum()) / 3;
  if (!(sigma_size < options.max_sigma_size)) return "size unsure";
  const double larger =
      larger_than_usual(prior_of(landmark.class_name(), map.units_a_true_metre()), fit.ellipsoid);
  if (larger > kFarTooLarge || larger < -kFarTooSmall) return "not of its class's size";
  return "";
}

void accept(ObjectLandmark& landmark, const BoxFit& found) {
  const ObjectFit& fit = found.fit;
  landmark.likeness = found.likeness;
  landmark.ellipsoid = fit.ellipsoid;
  const Eigen::Matrix3d R = fit.ellipsoid.T.matrix3();
  landmark.covariance = R * fit.covariance.topLeftCorner<3, 3>() * R.transpose();
}

}  // namespace cairn
