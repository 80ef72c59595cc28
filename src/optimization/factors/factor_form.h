#pragma once

namespace cairn {

/// How a factor says what it says; each factor's page in docs/factors/ has both.
enum class FactorForm {
  kPaper,   ///< the equation of Hosseinzadeh, Li, Latif, Reid
  kRobust,  ///< the same statement in radians, pixels or map units, for a least-squares solver
};

}  // namespace cairn
