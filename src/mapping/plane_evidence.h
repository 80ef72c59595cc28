#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "cairn/geometry/plane.h"

namespace cairn {

/// A measured point that may lie on a plane.
struct PlanePoint {
  Eigen::Vector3d position;
  double sigma = 1;  ///< by which it may lie off the plane: surfaces are not flat
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< σ of its depth, along its ray
  double worth = 1;  ///< of an independent one: those of one place are mostly of one thing

  double sigma_off(const Plane& plane) const {
    return std::hypot(sigma, along.dot(plane.normal()));
  }
};

/// A plane that explains what is known.
struct PlaneFit {
  Plane plane;
  bool by_points = true;  ///< else points say too little, and it is what pictures say alone
};

/// All that is known of one plane, in one frame: what pictures say of its normal and its place, and
/// points of which many lie on it.
class PlaneEvidence {
 public:
  /// `normal`: unit, to the side that pictures show; `sigma`: radians, about each axis across it.
  void add_normal(const Eigen::Vector3d& normal, double sigma);
  /// A direction (unit) that lies in it; `sigma`: radians.
  void add_direction(const Eigen::Vector3d& direction, double sigma);
  /// A place through which it goes, up to sigma.
  void add_place(const Eigen::Vector3d& place, double sigma);
  void add_point(const PlanePoint& point) { points_.push_back(point); }

  /// Unit; of what add_normal() was told.
  Eigen::Vector3d mean_normal() const { return normals_.normalized(); }

  /// The plane of least cost: squares for what pictures say; for points that they lie on it or
  /// anywhere else, behind it less likely than before it, as surfaces hide what is behind them
  /// (descents take a Cauchy loss of one σ in its place); and the logarithm of how many planes were
  /// possible for each that now is (Laplace's approximation of the evidence; MacKay 1992): three
  /// points always lie on a plane, and so say nothing. Its minima are many: descents begin at
  /// `start`, with a narrow and a wide loss, and at planes through three points (RANSAC; Fischler
  /// and Bolles 1981), the same ones in every call. Points that are not worth odds of twenty to one
  /// are left out. None where nothing is finite.
  std::optional<PlaneFit> solve(const Plane& start) const;
  /// Of a fit: its normal about the two axes across it, the lesser known, radians; its place at
  /// `at`.
  double sigma_angle(const PlaneFit& fit, const Eigen::Vector3d& at) const;
  double sigma_place(const PlaneFit& fit, const Eigen::Vector3d& at) const;

 private:
  struct Step;
  Step step(const Plane& plane, const Eigen::Vector3d& at, double width) const;
  Eigen::Matrix3d covariance(const PlaneFit& fit, const Eigen::Vector3d& at) const;
  Eigen::Vector3d foot(const Plane& plane) const;
  PlaneEvidence without_points() const;
  Plane descend(Plane plane, double width) const;
  double cost(const Plane& plane) const;

  double normal_weight_ = 0, place_weight_ = 0;
  Eigen::Vector3d normals_ = Eigen::Vector3d::Zero();     // weighted sum
  Eigen::Matrix3d directions_ = Eigen::Matrix3d::Zero();  // weighted sum of squares
  Eigen::Matrix4d places_ = Eigen::Matrix4d::Zero();      // weighted sum of squares, homogeneous
  std::vector<PlanePoint> points_;
};

}  // namespace cairn
