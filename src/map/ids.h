#pragma once

// The map room: what cairn knows of the world. Keyframes and landmarks addressed by typed ids, and
// the snapshot of them that trackers and viewers read. It knows neither how poses are estimated nor
// how landmarks are found.

#include <compare>
#include <cstdint>
#include <limits>

namespace cairn {

/// Names an element of a SlotMap. The generation tells an element from a later one in its slot.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t slot = kNone;
  std::uint32_t generation = 0;

  bool valid() const { return slot != kNone; }
  auto operator<=>(const Id&) const = default;
};

using KeyframeId = Id<struct KeyframeTag>;
using PointId = Id<struct PointTag>;

}  // namespace cairn
