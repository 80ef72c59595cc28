#pragma once

// Things on a table before cameras that go around them, as keyframes see them.

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "cairn/geometry/ellipse_projection.h"
#include "cairn/map/map.h"
#include "map/flat_map.h"

namespace cairn::testing {

/// A cup of usual size before the first of the cameras of around(), in metres.
inline Ellipsoid a_cup(const Eigen::Vector3d& centre = {0, 0, 1.2}) {
  return {SE3(so3_exp(Eigen::Vector3d(0.1, 0.3, -0.05)), centre), {0.06, 0.065, 0.055}};
}

/// Cameras on an arc of `span_deg` around (0, 0, 1.2), at a distance of 1.2, that look there from
/// somewhat above; the first one is in the middle between left and right.
inline std::vector<SE3> around(int count, double span_deg) {
  std::vector<SE3> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = (count > 1 ? double(i) / (count - 1) : 0) * span_deg * M_PI / 180;
    const Eigen::Quaterniond turn = so3_exp(Eigen::Vector3d(0, angle, 0)) *
                                    so3_exp(Eigen::Vector3d(-0.1 - 0.02 * (i % 3), 0, 0));
    const Eigen::Vector3d middle(0, 0, 1.2);
    poses.emplace_back(turn, middle - turn * middle);
  }
  return poses;
}

/// `count` points on an ellipsoid, evenly about.
inline std::vector<Eigen::Vector3d> points_on(const Ellipsoid& ellipsoid, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), angle = 2.4 * i;
    points.push_back(ellipsoid.T * ellipsoid.semi_axes.cwiseProduct(Eigen::Vector3d(
                                       r * std::cos(angle), r * std::sin(angle), z)));
  }
  return points;
}

/// A thing as a keyframe's picture shows it, without error.
inline SeenObject seen_thing(const Map& map, KeyframeId id, const Ellipsoid& thing,
                             const std::string& class_name = "cup") {
  const Keyframe& keyframe = map.keyframes()[id];
  const auto box =
      projected_box(map.view().pinhole(), {keyframe.T_wc.inverse() * thing.T, thing.semi_axes});
  if (!box) throw std::logic_error("the thing is not in front of the camera");
  SeenObject seen;
  seen.box = *box;
  seen.class_name = class_name;
  seen.score = 0.8;
  for (std::uint32_t i = 0; i < keyframe.frame->size(); ++i) {
    if (box->contains(keyframe.frame->pixel(i))) seen.keypoints.push_back(i);
  }
  return seen;
}

inline std::vector<KeyframeId> keyframes_in(const Map& map) {
  std::vector<KeyframeId> ids;
  map.keyframes().for_each([&](KeyframeId id, const Keyframe&) { ids.push_back(id); });
  return ids;
}

inline std::vector<ObjectId> objects_of(const Map& map) {
  std::vector<ObjectId> ids;
  map.objects().for_each([&](ObjectId id, const ObjectLandmark&) { ids.push_back(id); });
  return ids;
}

}  // namespace cairn::testing
