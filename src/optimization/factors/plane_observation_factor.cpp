#include "cairn/optimization/factors/plane_observation_factor.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "cairn/optimization/factors/sphere_log.h"
#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Matrix34d = Eigen::Matrix<double, 3, 4>;
using Matrix46d = Eigen::Matrix<double, 4, 6>;

Vector3d paper_residual(const PlaneMeasurement& measurement, const Plane::Hessian& prediction,
                        Matrix34d* by_prediction) {
  const Plane observed = measurement.plane();
  const double length = prediction.norm();
  Vector4d pi = prediction / length;
  const double side = pi.dot(observed.coefficients()) < 0 ? -1 : 1;
  pi *= side;
  Eigen::Matrix4d axes;  // of S³ at the observed plane, which is the last one
  axes << observed.tangent(), observed.coefficients();
  Matrix34d by_arc;
  const Vector3d e = sphere_log<3>(axes.transpose() * pi, by_prediction ? &by_arc : nullptr);
  const double information = 1 / measurement.sphere_sigma;
  if (by_prediction != nullptr) {
    const Eigen::Matrix4d by_length = Eigen::Matrix4d::Identity() - pi * pi.transpose();
    *by_prediction = information * side / length * by_arc * (axes.transpose() * by_length);
  }
  return information * e;
}

Vector3d robust_residual(const PlaneMeasurement& measurement, const Plane::Hessian& prediction,
                         Matrix34d* by_prediction) {
  const double side = prediction.head<3>().dot(measurement.normal) < 0 ? -1 : 1;
  const Vector3d normal = side * prediction.head<3>();
  Matrix3d axes;
  axes << tangent_axes(measurement.normal), measurement.normal;
  Eigen::Matrix<double, 2, 3> by_normal;
  const Eigen::Vector2d angles =
      sphere_log<2>(axes.transpose() * normal, by_prediction ? &by_normal : nullptr);
  const double distance = normal.dot(measurement.centroid) + side * prediction[3];
  const Matrix3d& W = measurement.square_root_information;
  if (by_prediction != nullptr) {
    Matrix34d J;
    J << by_normal * axes.transpose(), Eigen::Vector2d::Zero(), measurement.centroid.transpose(), 1;
    *by_prediction = side * W * J;
  }
  return W * Vector3d(angles.x(), angles.y(), distance);
}

// How the Hessian form of a plane that is fixed in some frame changes when T_w(frame) · exp(ξ)
// moves that frame: seen from outside, the plane moves along; seen from inside, the other way.
Matrix46d moved_along(const Plane::Hessian& plane) {
  Matrix46d J;
  J << Matrix3d::Zero(), -skew(plane.head<3>()), -plane.head<3>().transpose(),
      Eigen::RowVector3d::Zero();
  return J;
}

// Into the first columns; the last column of a block belongs to no direction.
template <typename Derived>
void write(const Eigen::MatrixBase<Derived>& derivative, double* jacobian) {
  constexpr int kSize = Derived::ColsAtCompileTime;
  Eigen::Map<Eigen::Matrix<double, 3, kSize + 1, Eigen::RowMajor>> J(jacobian);
  J.template leftCols<kSize>() = derivative;
  J.col(kSize).setZero();
}

}  // namespace

PlaneMeasurement PlaneMeasurement::isotropic(const Vector3d& normal, const Vector3d& centroid,
                                             double sigma_angle, double sigma_offset) {
  PlaneMeasurement m;
  m.normal = normal;
  m.centroid = centroid;
  m.square_root_information =
      Vector3d(1 / sigma_angle, 1 / sigma_angle, 1 / sigma_offset).asDiagonal();
  m.sphere_sigma = sigma_angle;
  return m;
}

PlaneMeasurement PlaneMeasurement::from_fit(const PlaneFit& fit, double min_sigma_angle,
                                            double min_sigma_offset) {
  Matrix3d covariance = fit.covariance;
  covariance.diagonal() += Vector3d(min_sigma_angle, min_sigma_angle, min_sigma_offset).cwiseAbs2();
  PlaneMeasurement m;
  m.normal = fit.plane.normal();
  m.centroid = fit.centroid;
  m.square_root_information = covariance.inverse().llt().matrixU();
  m.sphere_sigma = std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2);
  return m;
}

Vector3d plane_residual(const PlaneMeasurement& measurement, FactorForm form,
                        const Plane::Hessian& prediction, Matrix34d* by_prediction) {
  return form == FactorForm::kPaper ? paper_residual(measurement, prediction, by_prediction)
                                    : robust_residual(measurement, prediction, by_prediction);
}

bool PlaneObservationFactor::Evaluate(double const* const* parameters, double* residuals,
                                      double** jacobians) const {
  const SE3 T_wr = SE3Manifold::unpack(parameters[0]), T_wc = SE3Manifold::unpack(parameters[1]);
  const Plane plane_r = PlaneManifold::unpack(parameters[2]);
  const Eigen::Matrix4d to_camera = Plane::transform(T_wc.inverse() * T_wr);
  const Plane::Hessian prediction = to_camera * plane_r.hessian();
  Matrix34d J;
  Eigen::Map<Vector3d> e(residuals);
  e = plane_residual(measurement_, form_, prediction, jacobians ? &J : nullptr);
  if (jacobians == nullptr) return true;
  const Matrix34d J_r = J * to_camera;
  if (jacobians[0] != nullptr) write(J_r * moved_along(plane_r.hessian()), jacobians[0]);
  if (jacobians[1] != nullptr) write(-J * moved_along(prediction), jacobians[1]);
  if (jacobians[2] != nullptr) write(J_r * plane_r.hessian_by_step(), jacobians[2]);
  return true;
}

bool ReferencePlaneObservationFactor::Evaluate(double const* const* parameters, double* residuals,
                                               double** jacobians) const {
  const Plane plane = PlaneManifold::unpack(parameters[0]);
  const bool differentiate = jacobians != nullptr && jacobians[0] != nullptr;
  Matrix34d J;
  Eigen::Map<Vector3d> e(residuals);
  e = plane_residual(measurement_, form_, plane.hessian(), differentiate ? &J : nullptr);
  if (differentiate) write(J * plane.hessian_by_step(), jacobians[0]);
  return true;
}

bool FixedPlaneObservationFactor::Evaluate(double const* const* parameters, double* residuals,
                                           double** jacobians) const {
  const SE3 T_cw = SE3Manifold::unpack(parameters[0]).inverse();
  const Plane::Hessian prediction = Plane::transform(T_cw) * plane_w_.hessian();
  const bool differentiate = jacobians != nullptr && jacobians[0] != nullptr;
  Matrix34d J;
  Eigen::Map<Vector3d> e(residuals);
  e = plane_residual(measurement_, form_, prediction, differentiate ? &J : nullptr);
  if (differentiate) write(-J * moved_along(prediction), jacobians[0]);
  return true;
}

}  // namespace cairn
