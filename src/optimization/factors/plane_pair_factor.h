#pragma once

#include <ceres/cost_function.h>

#include <cstdint>
#include <vector>

#include "cairn/geometry/plane.h"

namespace cairn {

/// Whether two planes hang on two keyframes or on one and the same.
enum class PlaneFrames { kOne, kTwo };

/// Sizes of the blocks of a factor between two planes, in their order.
std::vector<std::int32_t> plane_pair_blocks(PlaneFrames frames);

/// A factor between the normals of two planes. Blocks: T_wr1, π_1, T_wr2, π_2 with two frames, and
/// with one frame, whose pose drops out, π_1, π_2 (see SE3Manifold, PlaneManifold). What it says of
/// the normals is the derived class's. Derivation: docs/factors/parallel_planes.md.
class PlanePairFactor : public ceres::CostFunction {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  static constexpr int kMaxResiduals = 2;
  using Residual = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxResiduals, 1>;
  using ByNormal = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxResiduals, 3>;

  PlanePairFactor(PlaneFrames frames, int residuals);

 private:
  /// Of two unit normals in one frame: the residual and its derivatives by them.
  virtual Residual relate(const Eigen::Vector3d& n1, const Eigen::Vector3d& n2, ByNormal& by_n1,
                          ByNormal& by_n2) const = 0;

  PlaneFrames frames_;
};

}  // namespace cairn
