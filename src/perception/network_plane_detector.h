#pragma once

#include "cairn/geometry/camera.h"
#include "cairn/perception/normals.h"
#include "cairn/perception/plane_agreement.h"
#include "cairn/perception/plane_detector.h"
#include "cairn/perception/plane_hypotheses.h"
#include "cairn/perception/scene_network.h"

namespace cairn {

struct NetworkPlaneOptions {
  int grid_columns =
      128;  ///< of the grid that planes are looked for in; rows by the picture's shape
  NormalOptions normals{.radius_px = 5};  ///< where no network gives normals
  PlaneHypothesisOptions hypothesis{.max_normal_deg = 25, .min_share = 0.02};
  /// The floors of the sigmas are what METER's planes are off from measured depth on redkitchen
  /// (docs/perception.md): its residuals do not show bends that reach over a whole plane.
  PlaneAgreementOptions agreement{.min_sigma_angle_deg = 18, .min_sigma_depth = 0.16};
  double colour_step =
      4;  ///< in Lab (8 bits a channel): of colour regions, where there are no labels
};

/// Planes from one picture by two hypotheses that must agree (paper, IV.A): regions of the labels
/// with normals and depth, and connected components of the depth's point cloud. Depth is that of a
/// network, so all lengths share one scale that is known to DetectedFrame::sigma_scale only.
class NetworkPlaneDetector : public PlaneDetector {
 public:
  /// The networks must give depth; Throws Error(kUsage) otherwise.
  NetworkPlaneDetector(SceneNetwork networks, const Camera& camera,
                       const NetworkPlaneOptions& options = {});
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  SceneNetwork networks_;
  NetworkPlaneOptions options_;
  cv::Mat_<cv::Vec3f> rays_;
};

/// The second half of the detector, after the networks: planes of maps of one grid. `bgr`: for
/// colour regions if there are no labels. `planar_labels`: as SceneNetwork has them.
std::vector<DetectedPlane> planes_of_maps(const SceneMaps& maps,
                                          const std::vector<std::string>& planar_labels,
                                          const cv::Mat_<cv::Vec3f>& rays, const cv::Mat& bgr,
                                          const NetworkPlaneOptions& options);

}  // namespace cairn
