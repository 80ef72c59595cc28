#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cairn/geometry/plane.h"

namespace cairn {

/// A plane through points, and how well they say where it is.
struct PlaneFit {
  bool usable = false;
  std::string refusal;  ///< a sentence for people where it is not usable
  Plane plane;          ///< the origin is on its positive side
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< weighted, of the inliers, on the plane
  /// Of the normal along tangent_axes(plane.normal()) (2, radians) and of the plane's distance at
  /// the centroid (1, units of the points). There, other than at the origin, the errors of normal
  /// and distance do not depend on each other. It counts the errors of the points as independent,
  /// takes their size from the residuals and is zero where three points leave no residuals.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double rms = 0;            ///< weighted, of the inliers' distances, units of the points
  int inliers = 0;           ///< points with a weight; of a robust fit those within the gate
  std::vector<char> inlier;  ///< one a point

  /// One line for logs.
  std::string to_string() const;
};

/// The plane with the least weighted sum of squared distances. `weights` are of one length with
/// `points` (1/σ² of their distances from the plane, up to a factor) or empty: equal ones. Refuses
/// fewer than three points with a weight, points on one line, numbers that are not finite.
PlaneFit fit_plane(std::span<const Eigen::Vector3d> points, std::span<const double> weights = {});

struct PlaneFitOptions {
  double max_distance = 0.05;  ///< of an inlier; units of the points, where their weight is 1
  int iterations = 200;        ///< RANSAC samples, at most
  int min_iterations = 20;     ///< at least, whatever the share of inliers
  double confidence = 0.999;   ///< to have drawn a sample without outliers
  int min_inliers = 10;
  int polish_iterations = 20;
};

/// The same with outliers among the points: samples of three, a truncated quadratic score, then
/// Tukey's M-estimator from the best one. A point of weight w is an inlier within
/// max_distance / √w. Points that are not finite are outliers. Deterministic for a seed.
PlaneFit fit_plane_robustly(std::span<const Eigen::Vector3d> points,
                            std::span<const double> weights, const PlaneFitOptions& options,
                            std::uint64_t seed);

}  // namespace cairn
