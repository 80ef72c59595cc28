#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>

#include "cairn/geometry/ellipsoid.h"
#include "cairn/geometry/plane.h"
#include "cairn/map/map.h"
#include "cairn/map/object_classes.h"

namespace cairn {

/// What is known of a thing before it is seen: its log semi-axes scatter with `sigma_size` around
/// those of a thing of its `shape` whose geometric mean is `usual`, and around their own mean with
/// `sigma_shape` around `shape`; its axes are turned as `turn`, in the frame of the ellipsoid's T,
/// with `sigma_turn` radians around each; it stands on `ground`.
struct ObjectPrior {
  double usual = 0;  ///< typical semi-axis, units of the map; 0: nothing is known of its size
  double sigma_size = 1, sigma_shape = 0.4;
  Eigen::Vector3d shape = Eigen::Vector3d::Zero();  ///< sums to 0; 0: a ball
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma_turn = Eigen::Vector3d::Constant(HUGE_VAL);
  std::optional<Plane> ground = {};  ///< what it stands on, normal towards it, frame of T
  double sigma_ground = 0;           ///< units of the map
};

/// What is known of a thing's form by its class; lengths of a map with so many units a metre (0:
/// not known). Wide: neither the class nor the metre may be right.
ObjectPrior prior_of(const std::string& class_name, double units_a_metre);

/// Adds that the thing has the shape of its class.
void expect_shape(ObjectPrior& prior, const ObjectClass& of_class);

/// Adds that the thing has its second axis upright; turned as `axes` otherwise. `up` in the same
/// frame.
void expect_upright(ObjectPrior& prior, const Eigen::Quaterniond& axes, const Upward& up);

/// e = 2 vec(q̂* q) / σ of an ellipsoid's axes turned by q, with its derivative by the rotation of a
/// step (may be null); rows without a finite σ are 0.
Eigen::Vector3d turn_residual(const ObjectPrior& prior, const Eigen::Quaterniond& q,
                              Eigen::Matrix3d* by_step);

/// The gap between a thing and its ground over σ, as in the robust form of SupportFactor, with its
/// derivative by a step (translation, rotation, log semi-axes; may be null). 0 without a ground.
double ground_residual(const ObjectPrior& prior, const Ellipsoid& e,
                       Eigen::Matrix<double, 1, 9>* by_step);

}  // namespace cairn
