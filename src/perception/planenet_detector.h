#pragma once

#include "cairn/perception/network.h"
#include "cairn/perception/plane_detector.h"

namespace cairn {

struct PlanenetOptions {
  double min_share = 0.008;    ///< of the picture; smaller planes are left out
  double max_distance_m = 50;  ///< of a plane from the camera; beyond, it is no measurement
  double sigma_angle_deg = 8;  ///< the network gives none
  double sigma_depth = 0.15;   ///< share of the depth
};

/// Planes straight from a network (PlaneNet, Liu et al. 2018; PlaneRCNN, Liu et al. 2019): its
/// parameters n d with n'x = d, and logits of masks. With a map more than there are planes, the
/// last one is that of no plane, and a pixel belongs to the largest logit; with as many, a pixel
/// belongs to the largest logit above 0. Planes are called "plane".
class PlanenetDetector : public PlaneDetector {
 public:
  /// Throws Error as Network does; kUsage if the card is not of kind planes.
  explicit PlanenetDetector(const NetworkCard& card, const PlanenetOptions& options = {});
  DetectedFrame detect(const PerceptionInput& input) override;

 private:
  Network network_;
  PlanenetOptions options_;
};

}  // namespace cairn
