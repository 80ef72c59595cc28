#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

struct TwoViewOptions {
  double sigma_px = 1.0;          ///< standard deviation of a point's position
  int iterations = 300;           ///< RANSAC samples for either model, at most
  double min_parallax_deg = 1.0;  ///< of the `min_points` (or the third, if more) that see it best
  int min_points = 50;            ///< matches that agree with the motion and have a depth
  double min_point_parallax_deg = 0.3;  ///< below it a match has no depth, but may agree
  double max_rival_share = 0.75;        ///< refuse if another motion explains more than this share
  double homography_share = 0.45;  ///< S_H / (S_H + S_E) from which a plane's motions are tried
};

/// What two views say. `usable` or a `refusal`: a sentence for people.
struct TwoViewResult {
  enum class Model { kNone, kEssential, kHomography };
  Model model = Model::kNone;  ///< where the motion came from
  bool usable = false;
  std::string refusal;
  SE3 T_21;                             ///< first camera to second, |t| = 1
  std::vector<Eigen::Vector3d> points;  ///< in the first camera; one a match
  std::vector<char> triangulated;       ///< whether points[i] is valid; one a match
  double parallax_deg = 0;              ///< the angle that is compared with min_parallax_deg
  int inliers = 0;                      ///< matches that agree with the motion, far ones included
};

/// The motion between two pictures of a static scene and the points, from matched pixels of the
/// ideal pinhole camera (pixels1[i] matches pixels2[i]; a pixel that is not finite agrees with
/// nothing). An essential matrix and a homography are fitted side by side; their motions vote by
/// the points that lie in front of both cameras, reproject within the chi-square gate and have
/// parallax. It refuses where two motions explain the matches about equally well (a plane has two),
/// and where the parallax is too small. Deterministic for a seed.
TwoViewResult reconstruct_two_views(std::span<const Eigen::Vector2d> pixels1,
                                    std::span<const Eigen::Vector2d> pixels2, const Pinhole& camera,
                                    const TwoViewOptions& options, std::uint64_t seed);

}  // namespace cairn
