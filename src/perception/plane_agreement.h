#pragma once

#include <vector>

#include "cairn/perception/detections.h"
#include "cairn/perception/plane_hypotheses.h"

namespace cairn {

struct PlaneAgreementOptions {
  double max_angle_deg = 15;       ///< between the planes of the two hypotheses
  double max_offset = 0.1;         ///< of their depths along the ray to the middle, share of it
  double min_overlap = 0.3;        ///< of the smaller one's pixels that both have
  double min_inlier_share = 0.7;   ///< of the plane that is fitted to what both have
  double merge_angle_deg = 8;      ///< two planes of a label within these become one
  double merge_offset = 0.05;      ///< share of the depth
  double max_hole_share = 0.02;    ///< of a mask; smaller holes are filled
  double correlated_px = 16;       ///< grid pixels over which errors of depth are alike
  double min_sigma_angle_deg = 1;  ///< what no residual shows: bends that all of the depth has
  double min_sigma_depth = 0.01;   ///< share of the depth
};

/// A plane that both hypotheses have.
struct AgreedPlane {
  PlaneHypothesis plane;
  double agreement = 0;  ///< 0 to 1: 1 where both are the same
};

/// How far two planes are apart along a ray (z = 1), as a share of the depth; infinite where the
/// ray does not meet both in front of the camera.
double relative_offset(const Eigen::Vector4d& a, const Eigen::Vector4d& b,
                       const Eigen::Vector3d& ray);

/// Pairs of hypotheses that agree in angle and offset, with their common pixels and the label of
/// the first; the plane is fitted anew to these (paper, IV.A).
std::vector<AgreedPlane> agreeing_planes(const OrganizedCloud& cloud,
                                         const std::vector<PlaneHypothesis>& of_regions,
                                         const std::vector<PlaneHypothesis>& of_components,
                                         const PlaneHypothesisOptions& hypothesis,
                                         const PlaneAgreementOptions& options);

/// Planes of one label that are one surface, seen in pieces, become one.
void merge_pieces(const OrganizedCloud& cloud, const PlaneHypothesisOptions& hypothesis,
                  const PlaneAgreementOptions& options, std::vector<AgreedPlane>& planes);

/// Gives planes the pixels next to them, up to `rounds` away, that lie on them by depth and are of
/// no other plane: normals near the edge of a surface are unusable, so that both hypotheses lack a
/// rim.
void grow_rims(const OrganizedCloud& cloud, const PlaneHypothesisOptions& hypothesis, int rounds,
               std::vector<AgreedPlane>& planes);

/// As detections in a picture of this size, by falling score.
std::vector<DetectedPlane> detected_planes(const OrganizedCloud& cloud, const cv::Size& picture,
                                           const std::vector<AgreedPlane>& planes,
                                           const PlaneHypothesisOptions& hypothesis,
                                           const PlaneAgreementOptions& options);

}  // namespace cairn
