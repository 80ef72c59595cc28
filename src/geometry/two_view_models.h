#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "cairn/geometry/epipolar.h"

namespace cairn {

/// A model of two views with the evidence for it. The score is the truncated symmetric transfer
/// error of Mur-Artal, Montiel and Tardos, "ORB-SLAM" (T-RO 2015), eq. 2: every match adds
/// max(0, 5.99 - d²) for its distance d (in sigmas) in either picture where d² is under the
/// chi-square gate, so that scores of different models can be compared.
struct ScoredModel {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  ///< E or H, on the planes z = 1
  double score = 0;
  std::vector<char> inliers;  ///< under the gate in both pictures
  int inlier_count = 0;
};

struct RansacOptions {
  int iterations = 300;       ///< at most
  int min_iterations = 40;    ///< at least, whatever the share of inliers
  double confidence = 0.999;  ///< to have drawn a sample without outliers
};

/// The essential matrix with the best score: five-point samples, each new best refined on its
/// inliers (LO-RANSAC, Chum, Matas and Kittler 2003). `px` is (fx, fy) / sigma_px. Needs five
/// matches; all finite.
ScoredModel estimate_essential(std::span<const NormalizedMatch> matches, const Eigen::Vector2d& px,
                               const RansacOptions& options, std::uint64_t seed);

/// The same for the homography: four-point samples, refits on the inliers.
ScoredModel estimate_homography(std::span<const NormalizedMatch> matches, const Eigen::Vector2d& px,
                                const RansacOptions& options, std::uint64_t seed);

}  // namespace cairn
