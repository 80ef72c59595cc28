#include "cairn/synthetic/prints/prints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cairn {
namespace {

constexpr float kFineTexels = 4000;  // a metre: things that are looked at from near by

Colour ink(Dice& dice) { return dice.colour(kPrints); }

bool is_dark(const Colour& colour) { return colour.mean() < 0.2f; }

Colour readable_on(const Colour& ground) {
  return Colour::Constant(is_dark(ground) ? 0.85f : 0.02f);
}

// Dark bars as long as words: what text looks like from further away than it can be read.
void text_lines(Canvas& canvas, float x, float y, float width, float height, float line,
                const Colour& colour, Dice& dice) {
  for (float down = 0; down + line <= height; down += 1.7f * line) {
    const float end = dice.chance(0.15f) ? width * dice.uniform(0.2f, 0.7f) : width;
    float across = 0;
    while (across < end) {
      const float word = std::min(line * dice.uniform(1.2f, 4.5f), end - across);
      canvas.rectangle(x + across, y + down, word, 0.62f * line, colour);
      across += word + 0.6f * line;
    }
  }
}

void picture_of_shapes(Canvas& canvas, float x, float y, float width, float height, Dice& dice) {
  canvas.rectangle(x, y, width, height, ink(dice));
  const float horizon = height * dice.uniform(0.45f, 0.7f);
  canvas.rectangle(x, y + horizon, width, height - horizon, ink(dice));
  canvas.disc(x + width * dice.uniform(0.25f, 0.75f), y + horizon * 0.5f,
              std::min(width, height) * dice.uniform(0.08f, 0.15f), ink(dice));
  for (int i = 0; i < 5; ++i) {
    const float left = x + width * dice.uniform(0, 0.7f), wide = width * dice.uniform(0.1f, 0.3f);
    const float top = y + height * dice.uniform(0.3f, 0.6f);
    if (dice.chance(0.5f))
      canvas.polygon({{left, y + horizon}, {left + wide / 2, top}, {left + wide, y + horizon}},
                     ink(dice));
    else
      canvas.rectangle(left, top, wide * 0.6f, y + height * 0.9f - top, ink(dice));
  }
}

}  // namespace

Print mug_print(float width, float height, const Colour& ground, Dice& dice) {
  Canvas canvas(width, height, std::min(kFineTexels, 900 / width), ground);
  switch (dice.below(5)) {
    case 0: {
      float y = height * dice.uniform(0.1f, 0.3f);
      for (int i = 2 + dice.below(4); i > 0 && y < 0.9f * height; --i) {
        const float thick = height * dice.uniform(0.03f, 0.14f);
        canvas.rectangle(0, y, width, thick, ink(dice));
        y += thick + height * dice.uniform(0.04f, 0.12f);
      }
      break;
    }
    case 1: {
      const Colour colours[] = {ink(dice), ink(dice)};
      const int around = 8 + dice.below(10);
      const float pitch = width / float(around);
      for (int row = 0; float(row) * pitch < height; ++row)
        for (int i = 0; i <= around; ++i)
          canvas.disc((float(i) + 0.5f * float(row % 2)) * pitch, (float(row) + 0.5f) * pitch,
                      0.28f * pitch, colours[(i + row) % 2]);
      break;
    }
    case 2: {
      const std::string name = dice.word(3, 6);
      const float tall = height * dice.uniform(0.18f, 0.3f);
      canvas.text(name, 0.5f * width, 0.55f * height, tall, readable_on(ground),
                  {.thickness = 0.18f, .max_width = 0.36f * width, .centred = true});
      canvas.rectangle(0.35f * width, 0.64f * height, 0.3f * width, 0.04f * height, ink(dice));
      break;
    }
    case 3:
      picture_of_shapes(canvas, 0.3f * width, 0.15f * height, 0.4f * width, 0.7f * height, dice);
      break;
    default:
      break;  // plain
  }
  return canvas.texture();
}

Print bottle_label(float width, float height, Dice& dice) {
  const Colour ground = dice.chance(0.6f) ? srgb(0xf3eee0) : ink(dice);
  Canvas canvas(width, height, kFineTexels, ground);
  const Colour accent = ink(dice);
  canvas.rectangle(0, 0, width, 0.06f * height, accent);
  canvas.rectangle(0, 0.94f * height, width, 0.06f * height, accent);
  for (int side = 0; side < 3; ++side) {  // in front and at the two backs of the seam
    const float x = width * (0.06f + 0.34f * float(side));
    const std::string name = dice.word(4, 7);
    const float tall = 0.16f * height;
    picture_of_shapes(canvas, x, 0.12f * height, 0.26f * width, 0.3f * height, dice);
    canvas.text(name, x, 0.64f * height, tall, readable_on(ground),
                {.thickness = 0.18f, .max_width = 0.26f * width});
    text_lines(canvas, x, 0.7f * height, 0.26f * width, 0.2f * height, 0.03f * height,
               readable_on(ground), dice);
  }
  return canvas.texture();
}

Print book_cover(float width, float height, const Colour& ground, Dice& dice) {
  Canvas canvas(width, height, 2500, ground);
  const Colour letters = readable_on(ground), accent = ink(dice);
  const int kind = dice.below(3);
  if (kind == 0)
    picture_of_shapes(canvas, 0.1f * width, 0.4f * height, 0.8f * width, 0.45f * height, dice);
  if (kind == 1) canvas.rectangle(0, 0.55f * height, width, 0.3f * height, accent);
  if (kind == 2)
    for (int i = 0; i < 6; ++i)
      canvas.disc(width * dice.uniform(0.1f, 0.9f), height * dice.uniform(0.45f, 0.85f),
                  width * dice.uniform(0.04f, 0.2f), ink(dice));
  float y = 0.16f * height;
  for (int line = 0; line < 2; ++line) {
    const std::string title = dice.word(4, 9);
    const float tall = 0.09f * height;
    canvas.text(title, 0.08f * width, y, tall, letters,
                {.thickness = 0.17f, .max_width = 0.84f * width});
    y += 1.5f * tall;
  }
  canvas.rectangle(0.08f * width, y - 0.02f * height, 0.5f * width, 0.008f * height, accent);
  canvas.text(dice.word(4, 7) + " " + dice.word(4, 8), 0.08f * width, 0.94f * height,
              0.035f * height, letters, {.max_width = 0.84f * width});
  return canvas.texture();
}

Print book_spine(float width, float height, const Colour& ground, Dice& dice) {
  // Drawn lying, as Canvas writes along x, and read with u along the spine.
  Canvas canvas(width, height, 2500, ground);
  const Colour accent = ink(dice);
  canvas.rectangle(0.04f * width, 0, 0.02f * width, height, accent);
  canvas.rectangle(0.9f * width, 0, 0.06f * width, height, accent);
  const std::string title = dice.word(4, 8) + " " + dice.word(3, 8);
  const float tall = 0.42f * height;
  canvas.text(title, 0.1f * width, 0.5f * height + 0.5f * tall, tall, readable_on(ground),
              {.thickness = 0.15f, .max_width = 0.55f * width});
  canvas.text(dice.word(4, 7), 0.7f * width, 0.5f * height + 0.3f * tall, 0.6f * tall,
              readable_on(ground), {.max_width = 0.19f * width});
  return canvas.texture();
}

Print page_edges(float width, float height, Dice& dice) {
  Canvas canvas(width, height, 2500, srgb(0xeee6d2));
  canvas.grain(0.16f, width, 0.0012f, dice.seed());
  return canvas.texture();
}

Print wood(float width, float height, const Colour& colour, Dice& dice) {
  Canvas canvas(width, height, std::min(1000.0f, 640 / std::max(width, height)), colour);
  const bool across = width >= height;
  for (const auto& [strength, along, thick] :
       {std::array{0.24f, 0.6f, 0.022f}, {0.16f, 0.15f, 0.004f}})
    canvas.grain(strength, across ? along : thick, across ? thick : along, dice.seed());
  return canvas.texture();
}

Print fabric(const Colour& colour, Dice& dice) {
  Canvas canvas(0.4f, 0.4f, 1000, colour);
  canvas.grain(0.12f, 0.05f, 0.05f, dice.seed());
  canvas.grain(0.22f, 0.0025f, 0.0025f, dice.seed());
  return canvas.texture();
}

Print poster_print(float width, float height, Dice& dice) {
  const Colour ground = ink(dice);
  Canvas canvas(width, height, 900 / std::max(width, height), ground);
  picture_of_shapes(canvas, 0.06f * width, 0.22f * height, 0.88f * width, 0.5f * height, dice);
  const std::string title = dice.word(4, 8);
  const float tall = 0.11f * height;
  canvas.text(title, 0.06f * width, 0.17f * height, tall, readable_on(ground),
              {.thickness = 0.18f, .max_width = 0.88f * width});
  text_lines(canvas, 0.06f * width, 0.76f * height, 0.88f * width, 0.18f * height, 0.018f * height,
             readable_on(ground), dice);
  return canvas.texture();
}

Print screen_content(float width, float height, Dice& dice) {
  const Colour ground = dice.colour(kPrints);
  Canvas canvas(width, height, 1024 / width, ground * 0.6f);
  const float unit = height / 100;
  picture_of_shapes(canvas, 0, 0, width, height, dice);
  const int windows = dice.chance(0.25f) ? 0 : 1 + dice.below(3);
  for (int i = 0; i < windows; ++i) {
    const float wide = width * dice.uniform(0.35f, 0.65f), tall = height * dice.uniform(0.4f, 0.7f);
    const float x = dice.uniform(0.02f * width, 0.98f * width - wide);
    const float y = dice.uniform(0.02f * height, 0.92f * height - tall);
    const bool dark = dice.chance(0.45f);
    const Colour paper = dark ? srgb(0x1f2430) : srgb(0xfafafa);
    canvas.rectangle(x, y, wide, tall, paper);
    canvas.rectangle(x, y, wide, 4 * unit, dark ? srgb(0x343b4a) : srgb(0xd4d8de));
    for (int button = 0; button < 3; ++button)
      canvas.disc(x + (2 + 3 * float(button)) * unit, y + 2 * unit, unit,
                  srgb(button == 0   ? 0xff5f57
                       : button == 1 ? 0xfebc2e
                                     : 0x28c840));
    float from = 0.04f * wide;
    if (dice.chance(0.5f)) {
      canvas.rectangle(x, y + 4 * unit, 0.2f * wide, tall - 4 * unit,
                       dark ? srgb(0x272d3a) : srgb(0xe9ecf0));
      text_lines(canvas, x + 0.02f * wide, y + 7 * unit, 0.15f * wide, tall - 12 * unit, 2 * unit,
                 dark ? srgb(0x8a93a6) : srgb(0x555b66), dice);
      from = 0.24f * wide;
    }
    const float rest = 0.96f * wide - from;
    float down = 7 * unit;
    while (down < tall - 10 * unit) {  // blocks of text in several colours, as code has them
      const float block = std::min(tall - down - 3 * unit, dice.uniform(6, 18) * unit);
      const Colour letters =
          dark ? Colour(ink(dice) * 0.5f + Colour::Constant(0.3f)) : srgb(0x22262c);
      text_lines(canvas, x + from + dice.uniform(0, 0.1f) * rest, y + down,
                 rest * dice.uniform(0.5f, 0.9f), block, 1.7f * unit, letters, dice);
      down += block + 3 * unit;
    }
  }
  canvas.rectangle(0, 95 * unit, width, 5 * unit, srgb(0x22252b));
  for (int i = 0; i < 8; ++i)
    canvas.rectangle((2 + 6 * float(i)) * unit, 96 * unit, 3.4f * unit, 3 * unit, ink(dice));
  return canvas.texture();
}

}  // namespace cairn
