#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/geometry/se3.h"

namespace cairn {

/// World points and where a camera sees them: pixels of the ideal pinhole camera and their standard
/// deviations (the feature's octave). All spans have one length; `sigmas_px` may be empty, which
/// means 1 pixel each.
struct Sightings {
  std::span<const Eigen::Vector3d> points_w;
  std::span<const Eigen::Vector2d> pixels;
  std::span<const double> sigmas_px;

  std::size_t size() const { return points_w.size(); }
  double sigma_px(std::size_t i) const { return sigmas_px.empty() ? 1.0 : sigmas_px[i]; }
};

struct ResectionOptions {
  int iterations = 200;       ///< RANSAC samples, at most
  int min_iterations = 20;    ///< at least, whatever the share of inliers
  double confidence = 0.999;  ///< to have drawn a sample without outliers
  double gate = 5.99;         ///< squared error in sigmas: chi-square, 95 %, 2 degrees of freedom
  int min_inliers = 15;
  int polish_iterations = 10;
};

struct ResectionResult {
  bool usable = false;
  std::string refusal;  ///< a sentence for people where it is not usable
  SE3 T_cw;
  std::vector<char> inlier;  ///< one a sighting
  int inliers = 0;
  double rms_sigmas = 0;  ///< of the inliers' reprojection errors
};

/// The pose of a camera from points that it sees, outliers among them: P3P samples, a truncated
/// quadratic score, each new best refined on its inliers (LO-RANSAC), and a polish at the end.
/// Sightings that are not finite are outliers. Deterministic for a seed.
ResectionResult resect(const Sightings& sightings, const Pinhole& camera,
                       const ResectionOptions& options, std::uint64_t seed);

/// Refines a pose on the sightings with a flag in `use`, by Levenberg-Marquardt with Huber weights
/// on the reprojection errors in sigmas.
SE3 refine_pose(const SE3& T_cw, const Sightings& sightings, const Pinhole& camera,
                std::span<const char> use, int iterations);

}  // namespace cairn
