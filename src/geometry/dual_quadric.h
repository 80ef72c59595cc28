#pragma once

#include <Eigen/Core>
#include <optional>

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// Q* = T diag(s1², s2², s3², -1) Tᵀ: the planes π that touch the ellipsoid have πᵀ Q* π = 0
/// (Hartley and Zisserman, Multiple View Geometry, 3.2; the paper, section III.A).
Eigen::Matrix4d dual_quadric(const Ellipsoid& ellipsoid);

/// The ellipsoid of a dual quadric of any scale and sign. None where it is not a bounded one: a
/// number not finite, the centre at infinity, a disc, a hyperboloid. Which axis comes first is
/// free; the rotation is a proper one.
std::optional<Ellipsoid> ellipsoid_of(const Eigen::Matrix4d& Q);

/// πᵀ Q* π with Q* of unit Frobenius norm: 0 where the plane touches it (the paper, section III.D).
double tangency(const Eigen::Matrix4d& Q, const Eigen::Vector4d& plane);

}  // namespace cairn
