#include "cairn/optimization/factors/object_observation_factor.h"

#include <cmath>
#include <optional>

#include "cairn/optimization/object_manifold.h"

namespace cairn {
namespace {

constexpr double kNotInFront = 10 * kObjectLoss;  // of an edge, σ
int residuals_of(FactorForm form) { return form == FactorForm::kPaper ? 1 : 4; }

ObjectResidual paper_residual(const ObjectMeasurement& m, const std::optional<Box2>& box,
                              const BoxByEllipsoid& by_ellipsoid, ObjectResidualByStep* by_step) {
  const double information = std::sqrt(m.score) / m.sigma_iou;
  Eigen::RowVector4d by_edges = Eigen::RowVector4d::Zero();
  const double iou = box ? intersection_over_union(*box, m.box, &by_edges) : 0;
  if (by_step != nullptr) {
    by_step->setZero(1, 9);
    if (box) *by_step = -information * by_edges * by_ellipsoid;
  }
  return ObjectResidual::Constant(1, information * (1 - iou));
}

ObjectResidual robust_residual(const ObjectMeasurement& m, const std::optional<Box2>& box,
                               const BoxByEllipsoid& by_ellipsoid, ObjectResidualByStep* by_step) {
  const double information = std::sqrt(m.score) / m.sigma;
  if (by_step != nullptr) by_step->setZero(4, 9);
  if (!box) return ObjectResidual::Constant(4, kNotInFront);
  ObjectResidual e = box->edges() - m.box.edges();
  for (int i = 0; i < 4; ++i) {
    const double inside = i < 2 ? e[i] : -e[i];
    if (m.cut[i] && inside <= 0) {
      e[i] = 0;
    } else if (by_step != nullptr) {
      by_step->row(i) = information * by_ellipsoid.row(i);
    }
  }
  return information * e;
}

// Into the first columns; the last column of a block belongs to no direction.
template <typename Derived>
void write(const Eigen::MatrixBase<Derived>& derivative, double* jacobian) {
  constexpr int kSize = Derived::ColsAtCompileTime;
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kSize + 1, Eigen::RowMajor>> J(
      jacobian, derivative.rows(), kSize + 1);
  J.template leftCols<kSize>() = derivative;
  J.col(kSize).setZero();
}

}  // namespace

ObjectResidual object_residual(const ObjectMeasurement& measurement, FactorForm form,
                               const Ellipsoid& in_camera, ObjectResidualByStep* by_step) {
  BoxByEllipsoid by_ellipsoid = BoxByEllipsoid::Zero();
  std::optional<Box2> box =
      projected_box(measurement.pinhole, in_camera, by_step ? &by_ellipsoid : nullptr);
  if (box && !(box->edges().allFinite() && by_ellipsoid.allFinite())) box.reset();
  return form == FactorForm::kPaper ? paper_residual(measurement, box, by_ellipsoid, by_step)
                                    : robust_residual(measurement, box, by_ellipsoid, by_step);
}

ObjectObservationFactor::ObjectObservationFactor(FactorForm form,
                                                 const ObjectMeasurement& measurement)
    : form_(form), measurement_(measurement) {
  set_num_residuals(residuals_of(form));
}

bool ObjectObservationFactor::Evaluate(double const* const* parameters, double* residuals,
                                       double** jacobians) const {
  const SE3 T_wr = SE3Manifold::unpack(parameters[0]), T_wk = SE3Manifold::unpack(parameters[1]);
  const Ellipsoid in_reference = ObjectManifold::unpack(parameters[2]);
  const SE3 T_ke = T_wk.inverse() * T_wr * in_reference.T;  // the ellipsoid's axes to the keyframe
  const Ellipsoid in_camera{measurement_.T_kc.inverse() * T_ke, in_reference.semi_axes};
  ObjectResidualByStep J;
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
      object_residual(measurement_, form_, in_camera, jacobians ? &J : nullptr);
  if (jacobians == nullptr) return true;
  const auto by_pose = J.leftCols<6>();
  if (jacobians[0] != nullptr) write(by_pose * adjoint(in_reference.T.inverse()), jacobians[0]);
  if (jacobians[1] != nullptr) write(-by_pose * adjoint(T_ke.inverse()), jacobians[1]);
  if (jacobians[2] != nullptr) write(J, jacobians[2]);
  return true;
}

ReferenceObjectObservationFactor::ReferenceObjectObservationFactor(
    FactorForm form, const ObjectMeasurement& measurement)
    : form_(form), measurement_(measurement) {
  set_num_residuals(residuals_of(form));
}

bool ReferenceObjectObservationFactor::Evaluate(double const* const* parameters, double* residuals,
                                                double** jacobians) const {
  const bool differentiate = jacobians != nullptr && jacobians[0] != nullptr;
  ObjectResidualByStep J;
  Ellipsoid in_camera = ObjectManifold::unpack(parameters[0]);
  in_camera.T = measurement_.T_kc.inverse() * in_camera.T;
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) =
      object_residual(measurement_, form_, in_camera, differentiate ? &J : nullptr);
  if (differentiate) write(J, jacobians[0]);
  return true;
}

}  // namespace cairn
