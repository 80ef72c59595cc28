#pragma once

#include <ceres/sized_cost_function.h>

#include <array>

#include "cairn/geometry/box.h"
#include "cairn/geometry/camera.h"
#include "cairn/geometry/ellipse_projection.h"
#include "cairn/optimization/factors/factor_form.h"

namespace cairn {

/// A thing as one picture shows it.
struct ObjectMeasurement {
  Pinhole pinhole;
  Box2 box;
  std::array<bool, 4> cut{};  ///< edges (left, top, right, bottom) that the border cut
  double sigma = 2;           ///< robust form: of an edge, pixels
  double sigma_iou = 0.1;     ///< paper form: of 1 − IoU
  double score = 1;           ///< the weight of the square
  SE3 T_kc = {};              ///< of the picture's camera to the keyframe that it hangs on
};

using ObjectResidual = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
using ObjectResidualByStep = Eigen::Matrix<double, Eigen::Dynamic, 9, 0, 4, 9>;

/// Of a view, in σ: where Cauchy's loss of the robust form lets go.
inline constexpr double kObjectLoss = 3;

/// The residual of an ellipsoid in the camera's frame, in σ and times √score. Paper: 1 − IoU of its
/// box and the one that is seen, one number. Robust: the four edges of the two, of which cut ones
/// count only where the prediction ends farther inside; four numbers. What is not in front of the
/// camera gets a constant beyond the loss and no derivative, so that it neither stops a solver nor
/// tempts it. `by_step`: derivative by the ellipsoid's step (see BoxByEllipsoid); may be null.
ObjectResidual object_residual(const ObjectMeasurement& measurement, FactorForm form,
                               const Ellipsoid& in_camera, ObjectResidualByStep* by_step);

/// A landmark of keyframe r seen from keyframe k, or from a camera that hangs on it. Blocks: T_wr,
/// T_wk (see SE3Manifold), the object in r (see ObjectManifold). Derivation:
/// docs/factors/object_observation.md.
class ObjectObservationFactor : public ceres::SizedCostFunction<ceres::DYNAMIC, 7, 7, 10> {
 public:
  ObjectObservationFactor(FactorForm form, const ObjectMeasurement& measurement);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  ObjectMeasurement measurement_;
};

/// The same where the reference keyframe itself sees the landmark (Ceres takes no block twice, and
/// the pose drops out). Block: the object.
class ReferenceObjectObservationFactor : public ceres::SizedCostFunction<ceres::DYNAMIC, 10> {
 public:
  ReferenceObjectObservationFactor(FactorForm form, const ObjectMeasurement& measurement);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  ObjectMeasurement measurement_;
};

}  // namespace cairn
