#include "cairn/synthetic/model.h"

#include <algorithm>
#include <array>

#include "cairn/geometry/error.h"
#include "cairn/synthetic/models/makers.h"

namespace cairn {
namespace {

struct Maker {
  std::string_view class_name;
  Model (*make)(Dice&);
};

constexpr Maker kMakers[] = {
    {"cup", make_cup},
    {"bottle", make_bottle},
    {"bowl", make_bowl},
    {"vase", make_vase},
    {"wine glass", make_wine_glass},
    {"book", make_book},
    {"keyboard", make_keyboard},
    {"mouse", make_mouse},
    {"tv", make_tv},
    {"laptop", make_laptop},
    {"cell phone", make_cell_phone},
    {"chair", make_chair},
    {"dining table", make_dining_table},
    {"couch", make_couch},
    {"bed", make_bed},
    {"bench", make_bench},
    {"shelf", make_shelf},
    {"cabinet", make_cabinet},
    {"clock", make_clock},
    {"suitcase", make_suitcase},
    {"backpack", make_backpack},
    {"sports ball", make_sports_ball},
    {"refrigerator", make_refrigerator},
    {"microwave", make_microwave},
    {"apple", make_apple},
    {"orange", make_orange},
    {"banana", make_banana},
    {"remote", make_remote},
    {"potted plant", make_potted_plant},
    {"tree", make_tree},
    {"door", make_door},
    {"window", make_window},
    {"poster", make_poster},
    {"lamp", make_lamp},
    {"floor lamp", make_floor_lamp},
    {"car", make_car},
    {"truck", make_truck},
    {"bus", make_bus},
    {"traffic light", make_traffic_light},
    {"stop sign", make_stop_sign},
    {"fire hydrant", make_fire_hydrant},
};

constexpr auto kClasses = [] {
  std::array<std::string_view, std::size(kMakers)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kMakers[i].class_name;
  return names;
}();

// So that the same seed means another colour for a cup than for a bowl (FNV-1a).
std::uint64_t seed_of_class(std::string_view class_name) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : class_name) hash = (hash ^ std::uint64_t(c)) * 0x100000001b3ull;
  return hash;
}

}  // namespace

std::span<const std::string_view> model_classes() { return kClasses; }

Model make_model(std::string_view class_name, std::uint64_t seed) {
  const auto* maker = std::ranges::find(kMakers, class_name, &Maker::class_name);
  if (maker == std::end(kMakers))
    throw Error(Error::Kind::kUsage, "There is no model of the class '" + std::string(class_name) +
                                         "'; use one of those that model_classes() lists.");
  Dice dice(Sampler(seed).next() ^ seed_of_class(class_name));
  return maker->make(dice);
}

}  // namespace cairn
