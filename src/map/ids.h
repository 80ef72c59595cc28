#pragma once

// The map room: what cairn knows of the world. Keyframes and landmarks addressed by typed ids, and
// the snapshot of them that trackers and viewers read. It knows neither how poses are estimated nor
// how landmarks are found.

#include <compare>
#include <cstdint>

namespace cairn {

/// Names an element of a SlotMap. The generation tells an element from a later one in its slot.
/// With fewer bits than 32 for the slot the generation gets the rest of them, and comes round
/// again.
template <class Tag, int kSlotBits = 32>
struct Id {
  static constexpr std::uint32_t kNone = std::uint32_t{0xffffffff} >> (32 - kSlotBits);

  std::uint32_t slot : kSlotBits = kNone;
  std::uint32_t generation : (kSlotBits < 32 ? 32 - kSlotBits : 32) = 0;

  bool valid() const { return slot != kNone; }
  friend bool operator==(const Id& a, const Id& b) = default;
  friend std::strong_ordering operator<=>(const Id& a, const Id& b) { return a.key() <=> b.key(); }
  /// Slot, then generation.
  std::uint64_t key() const { return std::uint64_t{slot} << 32 | generation; }
};

using KeyframeId = Id<struct KeyframeTag>;
/// Of the millions that a map may hold, each is written down many times: so it is small. After 256
/// births in one slot an id comes again, so one that is kept for long needs a second look.
using PointId = Id<struct PointTag, 24>;
/// Rooms have dozens of planes; each of thousands of points may say on which it lies.
using PlaneId = Id<struct PlaneTag, 16>;
using ObjectId = Id<struct ObjectTag>;

}  // namespace cairn
