#pragma once

namespace cairn {

/// Pixels, x right, y down, pixel centres at integers: the left pixel's left edge is at -0.5.
struct Box2 {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

}  // namespace cairn
