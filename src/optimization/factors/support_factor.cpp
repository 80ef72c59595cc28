#include "cairn/optimization/factors/support_factor.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "cairn/optimization/object_manifold.h"
#include "cairn/optimization/plane_manifold.h"
#include "cairn/optimization/se3_manifold.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::RowVector4d;
using Eigen::Vector3d;
using Matrix46d = Eigen::Matrix<double, 4, 6>;

// A residual with its derivatives by the plane's Hessian form in the ellipsoid's frame and by the
// log semi-axes.
struct Contact {
  double value = 0;
  RowVector4d by_plane;
  RowVector3d by_axes;
};

// πᵀ Q̂* π, where Q* = diag(s², −1).
Contact tangency(const Plane::Hessian& plane, const Vector3d& semi_axes) {
  const Vector3d n = plane.head<3>(), s2 = semi_axes.cwiseAbs2();
  const double d = plane[3], norm = std::sqrt(s2.squaredNorm() + 1);
  const Vector3d reach2 = s2.cwiseProduct(n.cwiseAbs2());
  Contact c;
  c.value = (reach2.sum() - d * d) / norm;
  c.by_plane << 2 / norm * s2.cwiseProduct(n).transpose(), -2 / norm * d;
  c.by_axes = 2 / norm * reach2 - 2 * c.value / (norm * norm) * s2.cwiseAbs2();
  return c;
}

Contact gap(const Plane::Hessian& plane, const Vector3d& semi_axes, double side) {
  const Vector3d n = plane.head<3>(), s2 = semi_axes.cwiseAbs2();
  const double reach = semi_axes.cwiseProduct(n).norm();  // of the ellipsoid along the normal
  Contact c;
  c.value = side * plane[3] - reach;
  c.by_plane << -s2.cwiseProduct(n).transpose() / reach, side;
  c.by_axes = -s2.cwiseProduct(n.cwiseAbs2()) / reach;
  return c;
}

// How the Hessian form of a plane that is fixed in some frame changes when T_w(frame) · exp(ξ)
// moves that frame, seen from outside; as in the plane observation.
Matrix46d moved_along(const Plane::Hessian& plane) {
  Matrix46d J;
  J << Matrix3d::Zero(), -skew(plane.head<3>()), -plane.head<3>().transpose(), RowVector3d::Zero();
  return J;
}

// Into the first columns; the last column of a block belongs to no direction.
template <int kSize>
void write(const Eigen::Matrix<double, 1, kSize>& derivative, double* jacobian) {
  if (jacobian == nullptr) return;
  Eigen::Map<Eigen::Matrix<double, 1, kSize + 1>> J(jacobian);
  J << derivative, 0;
}

}  // namespace

SupportFactor::SupportFactor(FactorForm form, SupportFrames frames, double side, double sigma)
    : form_(form), frames_(frames), side_(side), inverse_sigma_(1.0 / sigma) {
  set_num_residuals(1);
  *mutable_parameter_block_sizes() = frames == SupportFrames::kTwo
                                         ? std::vector<std::int32_t>{7, 4, 7, 10}
                                         : std::vector<std::int32_t>{4, 10};
}

bool SupportFactor::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  const bool two = frames_ == SupportFrames::kTwo;
  const int plane_block = two ? 1 : 0, object_block = two ? 3 : 1;  // poses come before them
  const Plane plane = PlaneManifold::unpack(parameters[plane_block]);
  const Ellipsoid object = ObjectManifold::unpack(parameters[object_block]);
  SE3 T_rp;
  if (two) {
    T_rp = SE3Manifold::unpack(parameters[2]).inverse() * SE3Manifold::unpack(parameters[0]);
  }
  // The plane as the object's reference and as the ellipsoid itself has it.
  const Eigen::Matrix4d to_object = Plane::transform(object.T.inverse());
  const Eigen::Matrix4d to_reference = Plane::transform(T_rp);
  const Plane::Hessian h_p = plane.hessian(), h_r = to_reference * h_p, h_e = to_object * h_r;
  const Contact contact = form_ == FactorForm::kPaper ? tangency(h_e, object.semi_axes)
                                                      : gap(h_e, object.semi_axes, side_);
  residuals[0] = inverse_sigma_ * contact.value;
  if (jacobians == nullptr) return true;
  const RowVector4d by_e = inverse_sigma_ * contact.by_plane;
  const RowVector4d by_r = by_e * to_object, by_p = by_r * to_reference;
  write<3>(by_p * plane.hessian_by_step(), jacobians[plane_block]);
  Eigen::Matrix<double, 1, 9> by_step;
  by_step << -by_e * moved_along(h_e), inverse_sigma_ * contact.by_axes;
  write<9>(by_step, jacobians[object_block]);
  if (two) {
    write<6>(by_p * moved_along(h_p), jacobians[0]);
    write<6>(-by_r * moved_along(h_r), jacobians[2]);
  }
  return true;
}

}  // namespace cairn
