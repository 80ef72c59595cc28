#include "cairn/synthetic/models/keys.h"

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

struct Key {
  float row, column, width, depth;  // in pitches
};

// A row of the main block by its keys' widths; they fill 15 pitches.
void add_row(std::vector<Key>& keys, float row, std::span<const float> widths) {
  float column = 0;
  for (const float width : widths) {
    keys.push_back({row, column, width, 1});
    column += width;
  }
}

std::vector<Key> layout(const KeyOptions& options) {
  std::vector<Key> keys;
  float row = 0;
  if (options.function_row) {
    keys.push_back({0, 0, 1, 1});
    for (int i = 0; i < 12; ++i) keys.push_back({0, 2 + float(i) + 0.33f * float(i / 4), 1, 1});
    row = 1.2f;
  }
  const auto ones = [](float first, int count, float last) {
    std::vector<float> widths(std::size_t(count) + 2, 1.0f);
    widths.front() = first;
    widths.back() = last;
    return widths;
  };
  add_row(keys, row, ones(1, 12, 2));
  add_row(keys, row + 1, ones(1.5f, 12, 1.5f));
  add_row(keys, row + 2, ones(1.75f, 11, 2.25f));
  add_row(keys, row + 3, ones(2.25f, 10, 2.75f));
  constexpr float kLowest[] = {1.25f, 1.25f, 1.25f, 6.25f, 1.25f, 1.25f, 1.25f, 1.25f};
  add_row(keys, row + 4, kLowest);
  if (options.number_pad) {
    for (int i = 0; i < 3; ++i) {
      for (const int r : {0, 1}) keys.push_back({row + float(r), 15.3f + float(i), 1, 1});
      keys.push_back({row + 4, 15.3f + float(i), 1, 1});
    }
    keys.push_back({row + 3, 16.3f, 1, 1});
    for (int r = 0; r < 5; ++r)
      for (int i = 0; i < 4; ++i)
        if (i < 3 || r == 0 || r == 1 || r == 3)
          keys.push_back({row + float(r), 18.6f + float(i), 1, i == 3 && r > 0 ? 2.0f : 1.0f});
  }
  return keys;
}

}  // namespace

Keys make_keys(const KeyOptions& options, Dice& dice) {
  const std::vector<Key> all = layout(options);
  Keys keys;
  for (const Key& key : all) {
    keys.width = std::max(keys.width, (key.column + key.width) * options.pitch);
    keys.depth = std::max(keys.depth, (key.row + key.depth) * options.pitch);
  }
  Canvas canvas(keys.width, keys.depth, 4000, options.colour);
  const Colour ink = Colour::Constant(options.colour.mean() < 0.2f ? 0.7f : 0.03f);
  for (const Key& key : all) {
    const float wide = key.width * options.pitch - options.gap;
    const float deep = key.depth * options.pitch - options.gap;
    const float slope = std::min(options.height, 0.0025f);
    const float x = (key.row + key.depth / 2) * options.pitch;
    const float y = (key.column + key.width / 2) * options.pitch;
    keys.mesh.append(
        tapered_box({deep, wide}, {deep - 2 * slope, wide - 2 * slope}, options.height),
        at(x, y, 0));
    if (key.width > 3) continue;  // the space bar says nothing
    const std::string legend =
        key.width > 1 ? dice.word(3, 4) : std::string(1, char('A' + dice.below(26)));
    canvas.text(legend, y - wide / 2 + 0.004f, x + 0.001f, key.width > 1 ? 0.0028f : 0.0045f, ink);
  }
  print_from_above(keys.mesh, {0, 0});
  keys.legends = canvas.texture();
  return keys;
}

}  // namespace cairn
