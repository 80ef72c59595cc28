#include "cairn/optimization/object_prior.h"

#include "cairn/geometry/se3.h"

namespace cairn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSigmaOfClass = 0.3;  // of the logarithm of a size, added to the class's
constexpr double kSigmaShape = 0.3;    // of log semi-axes around those of the class

}  // namespace

ObjectPrior prior_of(const std::string& class_name, double units_a_metre) {
  ObjectPrior prior;
  const ObjectClass* known = find_object_class(class_name);
  if (known == nullptr) return prior;
  prior.usual = usual_size(*known) * units_a_metre;
  prior.sigma_size = std::hypot(known->sigma, kSigmaOfClass);
  return prior;
}

void expect_shape(ObjectPrior& prior, const ObjectClass& of_class) {
  prior.shape = class_shape(of_class);
  prior.sigma_shape = kSigmaShape;
}

// Upside down is upright, too.
void expect_upright(ObjectPrior& prior, const Eigen::Quaterniond& axes, const Upward& up) {
  const Vector3d height = axes * Vector3d::UnitY();
  const Vector3d side = height.dot(up.direction) < 0 ? -up.direction : up.direction;
  prior.turn = Eigen::Quaterniond::FromTwoVectors(height, side) * axes;
  prior.sigma_turn = {up.sigma, HUGE_VAL, up.sigma};
}

Vector3d turn_residual(const ObjectPrior& prior, const Eigen::Quaterniond& q, Matrix3d* by_step) {
  Eigen::Quaterniond turn = prior.turn.conjugate() * q;
  if (turn.w() < 0) turn.coeffs() *= -1;
  const Vector3d information = prior.sigma_turn.cwiseInverse();  // 0 where σ is infinite
  if (by_step) {
    *by_step = skew(turn.vec());
    by_step->diagonal().array() += turn.w();
    *by_step = (information.asDiagonal() * *by_step).eval();
  }
  return 2 * information.cwiseProduct(turn.vec());
}

double ground_residual(const ObjectPrior& prior, const Ellipsoid& e,
                       Eigen::Matrix<double, 1, 9>* by_step) {
  if (by_step) by_step->setZero();
  if (!prior.ground) return 0;
  const double reach = e.reach(prior.ground->normal());
  if (by_step) {
    const Vector3d a = e.T.rotation().conjugate() * prior.ground->normal();
    const Vector3d s2a = e.semi_axes.cwiseAbs2().cwiseProduct(a);
    *by_step << a.transpose(), -s2a.cross(a).transpose() / reach,
        -s2a.cwiseProduct(a).transpose() / reach;
    *by_step /= prior.sigma_ground;
  }
  return (prior.ground->signed_distance(e.centre()) - reach) / prior.sigma_ground;
}

}  // namespace cairn
