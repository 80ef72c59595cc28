#include "cairn/mapping/surface_normals.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "cairn/mapping/end_rays.h"

namespace cairn {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
constexpr double kReach = 0.06;       // of the neighbourhood's weight, at depth 1
constexpr double kRoughness = 0.015;  // of surfaces, relative to their depth
constexpr double kPixels = 0.3;       // that sightings err by
constexpr double kMostNoise = 0.3;    // of a depth, relative: no two views have measured it
constexpr double kSlope = 3;          // of surfaces against the picture, before anything is known
constexpr int kIterations = 9;
// Neighbours on a steep surface look like outliers at first: they are let go little by little, as
// the scale of the Cauchy loss is halved until it is that of the noise.
constexpr int kHalvings = 3;

// Of a point's depth, relative: the less the farther apart its first and last views are.
double depth_noise(const Map& map, const MapPoint& point) {
  const auto [first, last] = end_rays(map, point);
  const double parallax = first.cross(last).norm();
  const double error = kPixels / map.view().pinhole().fx;
  return error < kMostNoise * parallax ? error / parallax : kMostNoise;
}

}  // namespace

SurfaceNormals::SurfaceNormals(const Map& map, const Keyframe& keyframe)
    : keyframe_(keyframe), index_(keyframe.points.size(), kNone) {
  const SE3 T_cw = keyframe.T_wc.inverse();
  for (std::uint32_t i = 0; i < keyframe.points.size(); ++i) {
    if (!keyframe.points[i].valid()) continue;
    const MapPoint& point = map.points()[keyframe.points[i]];
    const Eigen::Vector3d X = T_cw * point.position;
    if (!(X.z() > 0)) continue;
    index_[i] = static_cast<std::uint32_t>(samples_.size());
    samples_.push_back(
        {X.x() / X.z(), X.y() / X.z(), 1 / X.z(), std::hypot(kRoughness, depth_noise(map, point))});
  }
}

Eigen::Vector3d SurfaceNormals::at(std::uint32_t keypoint) const {
  const Eigen::Matrix3d R_wc = keyframe_.T_wc.matrix3();
  if (index_[keypoint] == kNone) return R_wc.col(2);
  const Sample& center = samples_[index_[keypoint]];
  // Inverse depth over that of the point, less 1: slope · (x, y) + what the point itself is off.
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  const Eigen::Vector3d prior(1 / (kSlope * kSlope), 1 / (kSlope * kSlope),
                              1 / (center.noise * center.noise));
  struct Neighbour {
    Eigen::Vector3d row;
    double value, noise, weight;
  };
  thread_local std::vector<Neighbour> near;
  near.clear();
  for (const Sample& s : samples_) {
    const Eigen::Vector3d row(s.x - center.x, s.y - center.y, 1);
    const double distance2 = row.head<2>().squaredNorm() / (kReach * kReach);
    if (distance2 > 9) continue;
    near.push_back({row, s.inverse_depth / center.inverse_depth - 1, s.noise,
                    std::exp(-distance2 / 2) / (s.noise * s.noise)});
  }
  for (int k = 0; k < kIterations; ++k) {
    const double widen = std::exp2(std::max(0, kHalvings - k));
    Eigen::Matrix3d H = prior.asDiagonal();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const Neighbour& n : near) {
      const double off = (n.row.dot(fit) - n.value) / (widen * n.noise);
      const double weight = n.weight / (1 + off * off);
      H.noalias() += weight * n.row * n.row.transpose();
      g.noalias() += weight * n.value * n.row;
    }
    fit = H.ldlt().solve(g);
  }
  // 1/z = a x + b y + c is the plane a X + b Y + c Z = 1.
  const Eigen::Vector3d normal(fit.x(), fit.y(),
                               1 + fit.z() - fit.x() * center.x - fit.y() * center.y);
  if (!normal.allFinite() || !(normal.norm() > 0)) return R_wc.col(2);
  return R_wc * normal.normalized();
}

}  // namespace cairn
