#include "cairn/output/label_colour.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace cairn {

Rgb label_colour(const std::string& label) {
  const Rgb sky(86, 180, 233), orange(230, 159, 0), yellow(240, 228, 66), purple(204, 121, 167),
      vermilion(213, 94, 0), green(0, 158, 115), blue(0, 114, 178);
  const std::array<std::pair<std::string_view, Rgb>, 19> colours = {{
      {"wall", sky},          {"building", sky},    {"house", sky},       {"floor", orange},
      {"rug", orange},        {"road", orange},     {"sidewalk", orange}, {"earth", orange},
      {"grass", orange},      {"field", orange},    {"ceiling", yellow},  {"table", purple},
      {"cabinet", vermilion}, {"shelf", vermilion}, {"door", green},      {"windowpane", green},
      {"screen", green},      {"painting", green},  {"mirror", green},
  }};
  const auto* const known =
      std::find_if(colours.begin(), colours.end(), [&](const auto& c) { return c.first == label; });
  return known == colours.end() ? blue : known->second;
}

}  // namespace cairn
