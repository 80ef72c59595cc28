#pragma once

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/dice.h"

namespace cairn {

struct WheelLook {
  float radius = 0.32f, width = 0.2f;
  int spokes = 5;
  std::uint32_t rubber = 0, rim = 0, dark = 0;  ///< materials of the assembly
};

/// A wheel that turns about y; `outer` is +1 where its outer side looks to +y, -1 to -y.
void add_wheel(Assembly& car, const WheelLook& look, const Eigen::Vector3f& centre, float outer);

}  // namespace cairn
