#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cairn/perception/grid_regions.h"
#include "cairn/perception/organized_cloud.h"

namespace cairn {

/// Thresholds of both hypotheses. Lengths are relative: σ is that of DepthNoise at a pixel's depth.
struct PlaneHypothesisOptions {
  DepthNoise noise{};
  double max_normal_deg = 15;      ///< of a pixel's normal to its plane's
  double max_distance_sigmas = 3;  ///< of a pixel's depth to its plane's
  double max_step_deg = 6;         ///< between the normals of neighbours in one component
  double max_step_sigmas = 1.5;    ///< of a neighbour's distance from the other's tangent plane
  double min_share = 0.008;        ///< of the grid; smaller planes are left out
  int max_directions = 6;          ///< of normals in one region or component

  /// min_share of a grid, but not less than a fit needs.
  int least_pixels(const cv::Size& grid) const;
};

/// A plane and the pixels of the grid that speak for it.
struct PlaneHypothesis {
  Eigen::Vector4d plane = Eigen::Vector4d::Zero();  ///< camera frame, unit normal, metres, d > 0
  GridRegion pixels;
  std::string label;  ///< empty: the hypothesis has none
};

/// How a plane fits a region.
struct RegionPlane {
  Eigen::Vector4d plane = Eigen::Vector4d::Zero();  ///< camera frame, unit normal, metres, d > 0
  double residual = 0;                              ///< robust RMS of ln(depth / the plane's depth)
  double inlier_share = 0;                          ///< of the region, within max_distance_sigmas
  double mean_depth = 0;                            ///< metres
  double spread = 0;  ///< metres, standard deviation of the points along the plane's short side
};

/// Robust fit (Tukey's biweight, reweighted) of a plane to the depth of a region, in inverse depth.
/// Nothing if the region's points span no plane.
std::optional<RegionPlane> fit_region(const OrganizedCloud& cloud, const GridRegion& region,
                                      const PlaneHypothesisOptions& options);

/// A labelled region, connected.
struct LabelledRegion {
  GridRegion pixels;
  std::string label;
};

/// Hypothesis 1 (paper, IV.A): for each region of planar labels, orientation from the normals by
/// their clusters (a region may hold several planes), offset from the depth by its densest layer.
std::vector<PlaneHypothesis> planes_of_regions(const OrganizedCloud& cloud,
                                               const std::vector<LabelledRegion>& regions,
                                               const PlaneHypothesisOptions& options);

/// Hypothesis 2: connected components of the organized cloud under normal and distance tests
/// (Trevor et al., Efficient Organized Point Cloud Segmentation with Connected Components, SPME
/// 2013), each split where it bends, with a plane fitted to the depth.
std::vector<PlaneHypothesis> planes_of_components(const OrganizedCloud& cloud,
                                                  const PlaneHypothesisOptions& options);

/// Distance of a pixel's depth from a plane's in its σ; infinite where either is unknown.
double distance_in_sigmas(const OrganizedCloud& cloud, const cv::Point& pixel,
                          const Eigen::Vector4d& plane, const DepthNoise& noise);

}  // namespace cairn
