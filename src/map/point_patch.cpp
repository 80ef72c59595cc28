#include "cairn/map/point_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr float kReach = 2.5F;         // pixels of an octave that a corner may be off
constexpr double kLeastSize = 0.3;     // pixels of the picture: patches that get smaller are blots
constexpr double kLeastCosine = 0.05;  // of the angle at which a facet is seen
constexpr double kMostStretch = 6;     // of a facet that is seen from aside

// Pixels of the picture a pixel of the ideal pinhole camera, which is at `at` in the picture.
Eigen::Matrix2d bend(const Undistorter& lens, const Eigen::Vector2d& pixel,
                     const Eigen::Vector2d& at) {
  Eigen::Matrix2d bend;
  bend.col(0) = lens.to_picture(pixel + Eigen::Vector2d::UnitX()) - at;
  bend.col(1) = lens.to_picture(pixel + Eigen::Vector2d::UnitY()) - at;
  return bend;
}

Eigen::Vector2f in_level(const ImagePyramid& pyramid, const Eigen::Vector2d& at, int level) {
  const cv::Point2f p =
      pyramid.from_base({static_cast<float>(at.x()), static_cast<float>(at.y())}, level);
  return {p.x, p.y};
}

Eigen::DiagonalMatrix<double, 2> ratio(const Picture& picture, int level) {
  const cv::Point2f r = picture.pyramid.ratio(level);
  return {r.x, r.y};
}

}  // namespace

std::shared_ptr<const PointPatch> cut_patch(const Picture& picture, const Pinhole& pinhole,
                                            const Eigen::Vector2d& pixel, int octave,
                                            const SE3& T_wc, const Eigen::Vector3d& position) {
  const Eigen::Vector2d at = picture.lens->to_picture(pixel);
  const auto patch = Patch::cut(picture.pyramid[octave], in_level(picture.pyramid, at, octave));
  const double z = (T_wc.inverse() * position).z();
  if (!patch || !(z > 0)) return nullptr;
  const Eigen::Matrix2d pixels = bend(*picture.lens, pixel, at).inverse() * ratio(picture, octave);
  Eigen::Matrix<double, 3, 2> steps;
  steps << pixels.row(0) * z / pinhole.fx, pixels.row(1) * z / pinhole.fy, 0, 0;
  if (!steps.allFinite()) return nullptr;
  const Eigen::Vector3d ray = position - T_wc.translation();
  return std::make_shared<PointPatch>(PointPatch{*patch, ray, T_wc.matrix3() * steps});
}

PointPatch PointPatch::turned(const Eigen::Vector3d& normal) const {
  const double towards = normal.dot(ray);
  if (!(std::abs(towards) > kLeastCosine * normal.norm() * ray.norm())) return *this;
  // Each pixel's ray meets the facet nearer to the camera or farther away: that of u goes along
  // ray * (1 + foreshortening . u) + steps * u.
  const Eigen::RowVector2d slope = normal.transpose() * steps / towards;
  return {patch, ray, steps - ray * slope, foreshortening + slope.transpose()};
}

std::optional<Eigen::Vector2d> find_patch(const PointPatch& patch, const Picture& picture,
                                          const Pinhole& pinhole, const SE3& T_cw,
                                          const Eigen::Vector3d& position,
                                          const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d X = T_cw * position;
  if (!(X.z() > 0)) return std::nullopt;
  const double x = X.x() / X.z(), y = X.y() / X.z();
  Eigen::Matrix<double, 2, 3> projection;
  projection << pinhole.fx, 0, -pinhole.fx * x, 0, pinhole.fy, -pinhole.fy * y;
  projection /= X.z();
  const Eigen::Vector2d at = picture.lens->to_picture(pixel);
  const Eigen::Matrix<double, 3, 2> steps = T_cw.matrix3() * patch.steps;
  const Eigen::Matrix2d A = bend(*picture.lens, pixel, at) * projection * steps;
  const Eigen::Vector2d foreshortening = patch.foreshortening + steps.row(2).transpose() / X.z();
  // In the octave that shows it at the size it had.
  const double size = std::sqrt(std::abs(A.determinant()));
  if (!(size > kLeastSize) || !(A.norm() < kMostStretch * size)) return std::nullopt;
  const ImagePyramid& pyramid = picture.pyramid;
  const int octave =
      pyramid.levels() < 2
          ? 0
          : std::clamp(static_cast<int>(std::lround(std::log(size) / std::log(pyramid.ratio(1).x))),
                       0, pyramid.levels() - 1);
  const Patch::Warp warp{(ratio(picture, octave).inverse() * A).cast<float>(),
                         foreshortening.cast<float>()};
  const auto found = patch.patch.find(pyramid[octave], in_level(pyramid, at, octave), warp, kReach);
  if (!found) return std::nullopt;
  const cv::Point2f base = pyramid.to_base({found->x(), found->y()}, octave);
  const Eigen::Vector2d result = picture.lens->to_pinhole({base.x, base.y}).cast<double>();
  if (!result.allFinite()) return std::nullopt;
  return result;
}

}  // namespace cairn
