#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>

#include "cairn/geometry/box.h"
#include "cairn/geometry/camera.h"
#include "cairn/geometry/ellipsoid.h"
#include "cairn/optimization/factors/factor_form.h"
#include "cairn/optimization/object_prior.h"

namespace cairn {

/// A box of the thing in a picture whose camera is known.
struct BoxView {
  SE3 T_cw;  ///< from the frame in which the ellipsoid is given to the camera
  Box2 box;
  std::array<bool, 4> cut{};  ///< edges (left, top, right, bottom) that the border cut
  double sigma = 2;           ///< of an edge, pixels
  double weight = 1;          ///< the score
};

struct ObjectFitOptions {
  FactorForm form = FactorForm::kRobust;
  double loss = 3;  ///< of a view, in σ (Cauchy); robust form only
  int max_steps = 100;
};

struct ObjectFit {
  bool usable = false;
  Ellipsoid ellipsoid;
  /// Of (translation, rotation, log semi-axes), as in BoxByEllipsoid; robust form only.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  double cost = 0;
  double median_error = 0;      ///< of the views' largest uncut edges, pixels
  int views = 0, agreeing = 0;  ///< of those, with all uncut edges within `loss` σ
  double span = 0;  ///< largest angle between directions in which agreeing views see it, radians
  int steps = 0;
  std::string to_string() const;
};

/// Fits an ellipsoid to boxes in pictures of known cameras, by Levenberg and Marquardt's method.
/// Paper: Σ score (1 − IoU)², semi-axes added to, no prior. Robust: the four edges in σ, cut ones
/// only where the prediction ends inside of the picture; Cauchy's loss on the view, weighted with
/// the score; log semi-axes with their prior. Not usable where no step is possible from the start.
/// Reference: docs/objects.md, "An ellipsoid from boxes".
ObjectFit fit_object(const Ellipsoid& start, std::span<const BoxView> views, const Pinhole& pinhole,
                     const ObjectPrior& prior, const ObjectFitOptions& options = {});

}  // namespace cairn
