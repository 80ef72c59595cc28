#pragma once

#include "cairn/optimization/factors/factor_form.h"

namespace cairn {

/// Switch, form and σ of a factor; docs/factors has a page for each.
struct FactorOptions {
  bool use = true;
  FactorForm form = FactorForm::kRobust;
  double sigma = 1;  ///< in the factor's own unit
};

struct PlaneFactorOptions {
  FactorOptions predicted_depth = {.sigma = 1};     ///< times the σ that pictures show
  FactorOptions observation = {.sigma = 1};         ///< times the σ that detector and picture give
  FactorOptions point_on_plane = {.sigma = 0.005};  ///< as a share of the viewing distance
  FactorOptions parallel = {.sigma = 1};            ///< degrees
  FactorOptions perpendicular = {.sigma = 1};       ///< degrees
  FactorOptions coplanar = {.sigma = 0.01};         ///< as a share of the viewing distance
};

struct ObjectFactorOptions {
  FactorOptions observation = {.sigma = 1};  ///< times the σ of a box's edge
  FactorOptions size = {.sigma = 1};         ///< times the σ of shape and size (ObjectPrior)
  FactorOptions support = {.sigma = 0.03};   ///< metres between a thing and what it stands on
};

}  // namespace cairn
