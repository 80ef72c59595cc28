#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/keys.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

const Eigen::Vector3f kAcross = Eigen::Vector3f::UnitY();

// A panel that shines with its picture over the dark glass that it is.
Material screen_material(const Print& content, Dice& dice) {
  return {.colour = Colour::Constant(0.04f),
          .texture = content,
          .gloss = 0.25f,
          .shininess = 80,
          .emission = Colour::Constant(dice.uniform(0.6f, 0.95f))};
}

// What is between a monitor and the table.
void add_stand(Assembly& tv, float width, float gap, float screen_height, std::uint32_t plastic,
               Dice& dice) {
  const float deep = dice.uniform(0.16f, 0.22f);
  const int kind = width > 0.85f ? 2 : dice.below(3);
  if (kind == 2) {  // two feet
    for (const float side : {-1.0f, 1.0f}) {
      const float y = side * 0.36f * width;
      const Path foot{{-deep / 2, y, 0.008f}, {0, y, gap}, {deep / 2, y, 0.008f}};
      tv.add(sweep(round_corners(foot, 0.03f), rounded_rectangle(0.02f, 0.014f, 0.004f)), plastic);
    }
    return;
  }
  const float plate = 0.012f;
  if (kind == 0)
    tv.add(box({deep, width * dice.uniform(0.34f, 0.5f), plate}, {.radius = 0.004f}), plastic);
  else
    tv.add(extrude(ellipse(deep * 0.55f, width * dice.uniform(0.2f, 0.26f), 32), plate, 0.003f),
           plastic);
  const float neck = gap + 0.35f * screen_height;
  tv.add(box({0.02f, dice.uniform(0.05f, 0.1f), neck}, {.radius = 0.005f}), plastic,
         at(-0.028f, 0, plate - 0.002f));
}

Print phone_content(float width, float height, Dice& dice) {
  Canvas canvas(width, height, 4000, dice.colour(kPrints));
  const float pitch = width / 4;
  canvas.disc(width * dice.uniform(0.2f, 0.8f), height * dice.uniform(0.2f, 0.8f), 0.5f * width,
              dice.colour(kPrints));
  for (int row = 1; float(row + 1) * pitch < height; ++row)
    for (int i = 0; i < 4; ++i)
      if (dice.chance(0.8f))
        canvas.rectangle((float(i) + 0.17f) * pitch, float(row) * pitch, 0.66f * pitch,
                         0.66f * pitch, dice.colour(kPrints));
  canvas.text("12:47", 0.06f * width, 0.5f * pitch, 0.2f * pitch, Colour::Ones());
  return canvas.texture();
}

}  // namespace

Model make_tv(Dice& dice) {
  Assembly tv("tv");
  const float width = dice.chance(0.75f) ? dice.uniform(0.46f, 0.66f) : dice.uniform(0.7f, 1.1f);
  const float height = width / (dice.chance(0.8f) ? 16.0f / 9 : 16.0f / 10);
  const float thick = dice.uniform(0.012f, 0.035f), bezel = dice.uniform(0.006f, 0.018f);
  const float chin = bezel + (dice.chance(0.4f) ? dice.uniform(0.005f, 0.02f) : 0);
  const float gap = width > 0.85f ? dice.uniform(0.05f, 0.08f) : dice.uniform(0.05f, 0.14f);
  const Colour colour = dice.chance(0.75f) ? srgb(0x18191b) : dice.colour(kPlastics);
  const auto plastic = tv.material({.colour = colour, .gloss = 0.25f});

  tv.add(box({thick, width + 2 * bezel, height + bezel + chin}, {.radius = 0.004f}), plastic,
         at(0, 0, gap));
  tv.add(cushion({0.03f, 0.55f * width, 0.6f * height}, 0.012f, 0.01f), plastic,
         at(-thick / 2 - 0.024f, 0, gap + 0.2f * height));  // its swollen front stays inside
  const auto screen = tv.material(screen_material(screen_content(width, height, dice), dice));
  tv.add(box({0.002f, width, height}), screen, at(thick / 2, 0, gap + chin));
  add_stand(tv, width, gap, height, plastic, dice);
  return std::move(tv).finish();
}

Model make_laptop(Dice& dice) {
  Assembly laptop("laptop");
  const float width = dice.uniform(0.29f, 0.38f), deep = width * dice.uniform(0.66f, 0.72f);
  const float thick = dice.uniform(0.012f, 0.02f), lid = 0.006f;
  const float opened = dice.uniform(98, 125);
  constexpr std::uint32_t kShells[] = {0xb9bcc0, 0x8f9499, 0x2b2d30, 0x1c1d1f, 0xd8d8d6, 0x5c6166};
  const Colour colour = dice.colour(kShells);
  const auto shell = laptop.material({.colour = colour, .gloss = 0.3f});
  const auto dark = laptop.material({.colour = Colour::Constant(0.012f), .gloss = 0.3f});
  const auto pad = laptop.material({.colour = colour * 0.75f, .gloss = 0.2f});

  laptop.add(box({deep, width, thick}, {.radius = 0.004f}), shell);
  KeyOptions options{.height = 0.0016f, .gap = 0.003f, .number_pad = width > 0.36f};
  options.colour = dice.chance(0.7f) ? Colour(Colour::Constant(0.02f)) : Colour(colour * 0.7f);
  options.pitch = (options.number_pad ? 0.94f / 22.6f : 0.86f / 15.0f) * width;
  options.pitch = std::min(options.pitch, 0.0195f);
  const Keys keys = make_keys(options, dice);
  const float keys_x = -deep / 2 + 0.028f;
  const auto legends = laptop.material({.colour = Colour::Ones(), .texture = keys.legends});
  laptop.add(box({keys.depth + 0.004f, keys.width + 0.004f, 0.001f}), dark,
             at(keys_x + keys.depth / 2, 0, thick - 0.0008f));
  laptop.add(keys.mesh, legends, at(keys_x, -keys.width / 2, thick));
  const float pad_deep = deep / 2 - (keys_x + keys.depth) - 0.02f;
  laptop.add(box({pad_deep, 0.3f * width, 0.0006f}), pad,
             at(deep / 2 - 0.01f - pad_deep / 2, 0, thick - 0.0002f));

  // The lid is built standing, its screen to the front, and leans back about its lower edge.
  const auto lean = at(-deep / 2 + 0.002f, 0, thick) * turned(kAcross, 90 - opened);
  const float high = deep * 0.98f, bezel = dice.uniform(0.006f, 0.014f);
  laptop.add(box({lid, width, high}, {.radius = 0.0025f}), shell, lean);
  laptop.add(box({0.001f, width - 0.006f, high - 0.006f}), dark, lean * at(lid / 2, 0, 0.003f));
  const float screen_w = width - 2 * bezel, screen_h = high - 2.8f * bezel;
  const auto screen =
      laptop.material(screen_material(screen_content(screen_w, screen_h, dice), dice));
  laptop.add(box({0.001f, screen_w, screen_h}), screen,
             lean * at(lid / 2 + 0.0006f, 0, 1.8f * bezel));
  return std::move(laptop).finish();
}

Model make_cell_phone(Dice& dice) {
  Assembly phone("cell phone");
  const float length = dice.uniform(0.136f, 0.165f), width = length * dice.uniform(0.46f, 0.5f);
  const float thick = dice.uniform(0.007f, 0.010f), corner = dice.uniform(0.006f, 0.012f);
  const float bezel = dice.uniform(0.002f, 0.005f);
  const auto body = phone.material({.colour = dice.colour(kMetals), .gloss = 0.6f});
  const auto glass =
      phone.material({.colour = Colour::Constant(0.012f), .gloss = 0.7f, .shininess = 120});
  phone.add(extrude(rounded_rectangle(length, width, corner, 4), thick, 0.0012f), body);
  phone.add(extrude(rounded_rectangle(length - 0.002f, width - 0.002f, corner, 4), 0.0006f), glass,
            at(0, 0, thick - 0.0003f));
  if (dice.chance(0.7f)) {
    const float screen_l = length - 4 * bezel, screen_w = width - 2 * bezel;
    const auto screen =
        phone.material(screen_material(phone_content(screen_w, screen_l, dice), dice));
    phone.add(box({screen_l, screen_w, 0.0004f}), screen, at(0, 0, thick));
  }
  return std::move(phone).finish();
}

}  // namespace cairn
