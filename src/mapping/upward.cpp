#include "cairn/mapping/upward.h"

#include <Eigen/Eigenvalues>

#include "cairn/map/plane_labels.h"

namespace cairn {
namespace {

constexpr double kSigmaByPlane = 0.05, kSigmaByCameras = 0.12;  // radians
constexpr double kLeastTurn = 0.02;  // of the squares of the cameras' level axes: across their mean

}  // namespace

std::optional<Upward> find_up(const Map& map) {
  Eigen::Matrix3d level = Eigen::Matrix3d::Zero();  // second moment of the cameras' right sides
  Eigen::Vector3d heads = Eigen::Vector3d::Zero();  // sum of where their upper sides point
  map.keyframes().for_each([&](KeyframeId, const Keyframe& keyframe) {
    const Eigen::Matrix3d R = keyframe.T_wc.matrix3();
    level += R.col(0) * R.col(0).transpose();
    heads -= R.col(1);
  });
  std::optional<Upward> up;
  std::size_t most = 0;
  map.planes().for_each([&](PlaneId id, const PlaneLandmark& landmark) {
    if (!carries_things(landmark.label()) || landmark.observations.size() <= most) return;
    most = landmark.observations.size();
    up = Upward{map.plane_in_world(id).normal(), kSigmaByPlane};
  });
  if (!up) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(level);
    if (!(axes.eigenvalues()[1] > kLeastTurn * axes.eigenvalues()[2])) return std::nullopt;
    up = Upward{axes.eigenvectors().col(0), kSigmaByCameras};
  }
  if (up->direction.dot(heads) < 0) up->direction *= -1;
  return up;
}

}  // namespace cairn
