#pragma once

#include <ceres/sized_cost_function.h>

#include "cairn/geometry/plane.h"
#include "cairn/geometry/plane_fit.h"
#include "cairn/optimization/factors/factor_form.h"

namespace cairn {

/// A patch of a plane as one picture shows it, in that camera's frame.
struct PlaneMeasurement {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    ///< unit
  Eigen::Vector3d centroid = Eigen::Vector3d::UnitZ();  ///< of the patch, on the plane; map units
  /// Robust form: W with WᵀW = Σ⁻¹, Σ of the normal along tangent_axes(normal) (2, radians) and of
  /// the plane's distance at the centroid (1, units of the map).
  Eigen::Matrix3d square_root_information = Eigen::Matrix3d::Identity();
  double sphere_sigma = 0.05;  ///< paper form: of π_obs on S³, radians

  /// The same σ along both axes of the normal, independent of the distance.
  static PlaneMeasurement isotropic(const Eigen::Vector3d& normal, const Eigen::Vector3d& centroid,
                                    double sigma_angle, double sigma_offset);
  /// Of a usable fit. The floors are positive and added in quadrature: what is wrong with all
  /// points alike, which the fit cannot see.
  static PlaneMeasurement from_fit(const PlaneFit& fit, double min_sigma_angle,
                                   double min_sigma_offset);

  Plane plane() const { return Plane::through(centroid, normal); }
};

/// The residual, in σ, of a plane predicted in the camera's frame. Paper: log of the prediction on
/// S³ at π_obs. Robust: the angle of its normal along the two axes of the observed one, and how far
/// it passes from the centroid. The side of the prediction does not matter. `by_prediction`:
/// derivative by the prediction's Hessian form; may be null. For solvers other than Ceres, too.
Eigen::Vector3d plane_residual(const PlaneMeasurement& measurement, FactorForm form,
                               const Plane::Hessian& prediction,
                               Eigen::Matrix<double, 3, 4>* by_prediction);

/// A landmark of keyframe r seen from keyframe c. Blocks: T_wr, T_wc (see SE3Manifold), π_r (see
/// PlaneManifold). Derivation: docs/factors/plane_observation.md.
class PlaneObservationFactor : public ceres::SizedCostFunction<3, 7, 7, 4> {
 public:
  PlaneObservationFactor(FactorForm form, const PlaneMeasurement& measurement)
      : form_(form), measurement_(measurement) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  PlaneMeasurement measurement_;
};

/// The same where the reference keyframe itself sees the landmark (Ceres takes no block twice, and
/// the pose drops out). Block: π_r.
class ReferencePlaneObservationFactor : public ceres::SizedCostFunction<3, 4> {
 public:
  ReferencePlaneObservationFactor(FactorForm form, const PlaneMeasurement& measurement)
      : form_(form), measurement_(measurement) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  PlaneMeasurement measurement_;
};

/// The same for a plane of the world that is held: what tracking needs. Block: T_wc.
class FixedPlaneObservationFactor : public ceres::SizedCostFunction<3, 7> {
 public:
  FixedPlaneObservationFactor(FactorForm form, const PlaneMeasurement& measurement,
                              const Plane& plane_w)
      : form_(form), measurement_(measurement), plane_w_(plane_w) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  FactorForm form_;
  PlaneMeasurement measurement_;
  Plane plane_w_;
};

}  // namespace cairn
