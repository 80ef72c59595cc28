#pragma once

#include "cairn/geometry/ellipsoid.h"

namespace cairn {

/// Wasserstein's 2-distance, metres, between two ellipsoids taken as normal distributions, of mean
/// c and covariance R diag(s²) Rᵀ: W² = |c₁ - c₂|² + tr(Σ₁ + Σ₂ - 2 (Σ₁^½ Σ₂ Σ₁^½)^½) (Dowson and
/// Landau, "The Fréchet distance between multivariate normal distributions", 1982). It tells also
/// how far apart two are that do not meet.
double wasserstein_distance(const Ellipsoid& a, const Ellipsoid& b);

}  // namespace cairn
