#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "cairn/map/map.h"
#include "cairn/map/object_classes.h"

namespace cairn {

/// What is known of a thing before it is seen: its log semi-axes scatter with `sigma_size` around
/// those of a thing of its `shape` whose geometric mean is `usual`, and around their own mean with
/// `sigma_shape` around `shape`; its axes are turned as `turn`, in the frame of the ellipsoid's T,
/// with `sigma_turn` radians around each.
struct ObjectPrior {
  double usual = 0;  ///< typical semi-axis, units of the map; 0: nothing is known of its size
  double sigma_size = 1, sigma_shape = 0.4;
  Eigen::Vector3d shape = Eigen::Vector3d::Zero();  ///< sums to 0; 0: a ball
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sigma_turn = Eigen::Vector3d::Constant(HUGE_VAL);
};

/// What is known of a thing's form by its class; lengths of a map with so many units a metre (0:
/// not known). Wide: neither the class nor the metre may be right.
ObjectPrior prior_of(const std::string& class_name, double units_a_metre);

/// Adds that the thing has the shape of its class, with its second axis upright; turned as `axes`
/// otherwise. `up` in the same frame.
void expect_upright(ObjectPrior& prior, const ObjectClass& of_class, const Eigen::Quaterniond& axes,
                    const Upward& up);

/// e = 2 vec(q̂* q) / σ of an ellipsoid's axes turned by q, with its derivative by the rotation of a
/// step (may be null); rows without a finite σ are 0.
Eigen::Vector3d turn_residual(const ObjectPrior& prior, const Eigen::Quaterniond& q,
                              Eigen::Matrix3d* by_step);

}  // namespace cairn
