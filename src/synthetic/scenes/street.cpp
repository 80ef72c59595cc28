#include "cairn/synthetic/scenes/makers.h"
namespace cairn { Scene make_street(std::uint64_t seed) { return make_desk(seed); } }
