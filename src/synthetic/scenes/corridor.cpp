#include "cairn/synthetic/scenes/makers.h"
namespace cairn { Scene make_corridor(std::uint64_t seed) { return make_desk(seed); } }
