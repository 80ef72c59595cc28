#include "cairn/mapping/upward.h"

#include <Eigen/Eigenvalues>

#include "cairn/map/plane_labels.h"

namespace cairn {
namespace {

constexpr double kSigmaByPlane = 0.05, kSigmaByCameras = 0.12;  // radians
constexpr double kLeastTurn = 0.02;  // of the squares of the cameras' level axes: across their mean

// The sum of where the cameras' upper sides point.
Eigen::Vector3d heads(const Map& map) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  map.keyframes().for_each(
      [&](KeyframeId, const Keyframe& keyframe) { sum -= keyframe.T_wc.matrix3().col(1); });
  return sum;
}

Upward upright(const Map& map, Upward up) {
  if (up.direction.dot(heads(map)) < 0) up.direction *= -1;
  return up;
}

}  // namespace

std::optional<Upward> up_by_cameras(const Map& map) {
  Eigen::Matrix3d level = Eigen::Matrix3d::Zero();  // second moment of the cameras' right sides
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    const Eigen::Vector3d right = keyframe.T_wc.matrix3().col(0);
    level += right * right.transpose();
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(level);
  if (!(axes.eigenvalues()[1] > kLeastTurn * axes.eigenvalues()[2])) return std::nullopt;
  return upright(map, {axes.eigenvectors().col(0), kSigmaByCameras});
}

std::optional<Upward> find_up(const Map& map) {
  std::optional<Upward> up;
  std::size_t most = 0;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!carries_things(landmark.label()) || landmark.observations.size() <= most) return;
    most = landmark.observations.size();
    up = Upward{map.plane_in_world(id).normal(), kSigmaByPlane};
  });
  return up ? upright(map, *up) : up_by_cameras(map);
}

}  // namespace cairn
