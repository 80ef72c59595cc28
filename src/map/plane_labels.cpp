#include "cairn/map/plane_labels.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace cairn {
namespace {

constexpr std::array<std::string_view, 4> kLevel = {"floor", "rug", "ceiling", "table"};
constexpr std::array<std::string_view, 6> kUpright = {"wall", "building",   "house",
                                                      "door", "windowpane", "painting"};

constexpr std::array<std::string_view, 9> kCarrying = {
    "floor", "rug", "table", "desk", "counter", "shelf", "bed", "road", "sidewalk"};

constexpr std::array<std::string_view, 2> kEndedByWalls = {"floor", "ceiling"};

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& labels, const std::string& label) {
  return std::find(labels.begin(), labels.end(), label) != labels.end();
}

}  // namespace

bool is_level(const std::string& label) { return is_one_of(kLevel, label); }

bool is_upright(const std::string& label) { return is_one_of(kUpright, label); }

bool carries_things(const std::string& label) { return is_one_of(kCarrying, label); }

bool is_ended_by_walls(const std::string& label) { return is_one_of(kEndedByWalls, label); }

std::optional<PlaneRelation> implied_relation(const std::string& a, const std::string& b) {
  const bool level_a = is_level(a), level_b = is_level(b);
  if (level_a && level_b) return PlaneRelation::kParallel;
  const bool square = (level_a && is_upright(b)) || (level_b && is_upright(a));
  return square ? std::optional(PlaneRelation::kPerpendicular) : std::nullopt;
}

}  // namespace cairn
