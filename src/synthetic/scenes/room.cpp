#include "cairn/synthetic/scenes/makers.h"
namespace cairn { Scene make_room(std::uint64_t seed) { return make_desk(seed); } }
