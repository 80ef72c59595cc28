#pragma once

#include <optional>

#include "cairn/geometry/camera.h"
#include "cairn/perception/normals.h"
#include "cairn/perception/plane_agreement.h"
#include "cairn/perception/plane_detector.h"
#include "cairn/perception/scene_network.h"

namespace cairn {

struct RgbdPlaneOptions {
  int grid_columns = 160;  ///< at most; rows by the picture's shape
  NormalOptions normals{.radius_px = 4};
  /// The noise is that of a structured-light sensor (Khoshelham and Oude Elberink 2012: 1.4 mm at
  /// one metre, growing with the square), with a share for what calibration leaves.
  PlaneHypothesisOptions hypothesis{.noise = {0.003, 0.003}, .max_step_deg = 10};
  PlaneAgreementOptions agreement{.merge_angle_deg = 4,
                                  .merge_offset = 0.02,
                                  .correlated_px = 8,
                                  .min_sigma_angle_deg = 0.5,
                                  .min_sigma_depth = 0.005};
};

/// Planes from measured depth: connected components (Trevor et al. 2013), the paper's baseline.
class RgbdPlaneDetector : public PlaneDetector {
 public:
  /// `labels`: a network that gives labels, by which planes are called what most of them is;
  /// without it they are called "plane".
  explicit RgbdPlaneDetector(const Camera& camera, std::optional<SceneNetwork> labels = {},
                             const RgbdPlaneOptions& options = {});
  /// A picture without measured depth, or of another shape than the camera's, is a problem.
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  void name_planes(const cv::Mat& bgr, std::vector<AgreedPlane>& planes);

  Camera camera_;
  std::optional<SceneNetwork> labels_;
  RgbdPlaneOptions options_;
  cv::Mat_<cv::Vec3f> rays_;
};

}  // namespace cairn
