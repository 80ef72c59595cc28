#pragma once

#include <cstdint>

#include "cairn/features/orb_extractor.h"

namespace cairn {

enum class Pace { kLockstep, kRealtime };

/// Every setting of the system. Keys, units and ranges as users see them: option_table.h.
struct Options {
  Pace pace = Pace::kRealtime;
  int threads = 0;  ///< 0: all cores
  std::uint64_t seed = 0;
  OrbOptions features;
};

}  // namespace cairn
