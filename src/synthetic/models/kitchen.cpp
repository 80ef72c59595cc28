#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

constexpr std::uint32_t kAppliances[] = {0xf0f0ee, 0xe4e4e0, 0xb4b7ba, 0x9a9da0, 0x1f2022};

// A rod before the front, held at both ends; along z where upright, else along y.
void add_bar_handle(Assembly& thing, const Eigen::Vector3f& middle, float length, bool upright,
                    float reach, std::uint32_t metal) {
  const Eigen::Vector3f along = upright ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitY();
  const Eigen::Vector3f out = reach * Eigen::Vector3f::UnitX(), half = along * length / 2;
  thing.add(
      tube(round_corners({middle - half, middle - half + out, middle + half + out, middle + half},
                         0.02f, 3),
           0.009f),
      metal);
}

}  // namespace

Model make_refrigerator(Dice& dice) {
  Assembly fridge("refrigerator");
  const float width = dice.uniform(0.55f, 0.72f), deep = dice.uniform(0.58f, 0.68f);
  const float height = dice.uniform(1.5f, 1.95f), split = dice.uniform(0.3f, 0.68f);
  const bool freezer_below = split < 0.5f;
  const Colour colour = dice.colour(kAppliances);
  const auto body = fridge.material({.colour = colour * 0.9f, .gloss = 0.3f});
  const auto front = fridge.material({.colour = colour, .gloss = 0.45f});
  const auto dark = fridge.material({.colour = Colour::Constant(0.015f)});
  const auto metal = fridge.material({.colour = srgb(0xa5a8ab), .gloss = 0.6f});
  const float foot = 0.04f, leaf = 0.055f, gap = 0.008f;
  const float side = dice.chance(0.5f) ? 1.0f : -1.0f;
  fridge.add(box({deep - 0.04f, width - 0.04f, foot + 0.01f}), dark, at(-0.02f, 0, 0));
  fridge.add(box({deep, width, height - foot}, {.radius = 0.006f}), body, at(0, 0, foot));
  const float cut = foot + split * (height - foot);
  const float x = deep / 2 + leaf / 2 + 0.006f;
  fridge.add(box({0.01f, width - 0.03f, height - foot - 0.03f}), dark,
             at(deep / 2 + 0.003f, 0, foot + 0.015f));
  const auto leaf_box = [&](float from, float to) {
    fridge.add(box({leaf, width - 0.004f, to - from}, {.radius = 0.01f, .steps = 2}), front,
               at(x, 0, from));
  };
  leaf_box(foot + 0.004f, cut - gap);
  leaf_box(cut + gap, height);
  const float y = side * (width / 2 - 0.06f), out = x + leaf / 2;
  for (const bool upper : {false, true}) {
    const float length = upper == freezer_below ? 0.45f : 0.28f;
    const float z = upper ? cut + 0.06f + length / 2 : cut - 0.06f - length / 2;
    add_bar_handle(fridge, {out - 0.004f, y, z}, length, true, 0.045f, metal);
  }
  // Notes and magnets.
  for (int i = dice.below(5); i > 0; --i) {
    const float size = dice.uniform(0.05f, 0.13f);
    const auto note = fridge.material(
        {.colour = Colour::Ones(), .texture = poster_print(size, 1.3f * size, dice)});
    fridge.add(box({0.002f, size, 1.3f * size}), note,
               at(out + 0.0005f, dice.uniform(-0.35f, 0.35f) * (width - 0.2f) - side * 0.04f,
                  cut + dice.uniform(0.08f, 0.2f) * (height - cut) + 0.05f * float(i)));
  }
  return std::move(fridge).finish();
}

Model make_microwave(Dice& dice) {
  Assembly microwave("microwave");
  const float width = dice.uniform(0.44f, 0.53f), deep = dice.uniform(0.32f, 0.4f);
  const float height = dice.uniform(0.25f, 0.3f), panel = width * dice.uniform(0.2f, 0.26f);
  const Colour colour = dice.colour(kAppliances);
  const auto body = microwave.material({.colour = colour, .gloss = 0.4f});
  const auto glass =
      microwave.material({.colour = Colour::Constant(0.01f), .gloss = 0.7f, .shininess = 100});
  const auto metal = microwave.material({.colour = srgb(0xa5a8ab), .gloss = 0.6f});
  const float foot = 0.012f, tall = height - foot, front = deep / 2;
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f})
      microwave.add(extrude(circle(0.015f, 10), foot + 0.004f), glass,
                    at(sx * 0.36f * deep, sy * 0.4f * width, 0));
  microwave.add(box({deep, width, tall}, {.radius = 0.008f}), body, at(0, 0, foot));
  const float door = width - panel - 0.012f, door_y = -width / 2 + 0.006f + door / 2;
  microwave.add(box({0.02f, door, tall - 0.012f}, {.radius = 0.006f}), body,
                at(front + 0.006f, door_y, foot + 0.006f));
  microwave.add(box({0.004f, 0.82f * door, 0.74f * tall}, {.radius = 0.0015f}), glass,
                at(front + 0.015f, door_y - 0.02f * door, foot + 0.13f * tall));
  add_bar_handle(microwave, {front + 0.012f, door_y + 0.46f * door, foot + tall / 2}, 0.66f * tall,
                 true, 0.032f, metal);
  // The panel: a clock and rows of keys.
  const Colour ground =
      dice.chance(0.6f) ? Colour(Colour::Constant(0.015f)) : Colour(colour * 0.7f);
  const Colour ink = Colour::Constant(ground.mean() < 0.2f ? 0.55f : 0.02f);
  const float pw = panel - 0.016f, ph = tall - 0.012f;
  Canvas keys(pw, ph, 3000, ground);
  keys.rectangle(0.12f * pw, 0.06f * ph, 0.76f * pw, 0.14f * ph, srgb(0x06140c));
  keys.text("10:24", 0.5f * pw, 0.165f * ph, 0.07f * ph, srgb(0x54f0a0),
            {.max_width = 0.64f * pw, .centred = true});
  for (int row = 0; row < 5; ++row)
    for (int i = 0; i < 3; ++i) {
      keys.rectangle((0.12f + 0.27f * float(i)) * pw, (0.27f + 0.11f * float(row)) * ph, 0.2f * pw,
                     0.075f * ph, Colour(ground + 0.12f * (ink - ground)));
      keys.text(std::to_string((3 * row + i + 1) % 10), (0.22f + 0.27f * float(i)) * pw,
                (0.325f + 0.11f * float(row)) * ph, 0.035f * ph, ink, {.centred = true});
    }
  keys.disc(0.5f * pw, 0.9f * ph, 0.14f * pw, ink);
  const auto print =
      microwave.material({.colour = Colour::Ones(), .texture = keys.texture(), .gloss = 0.3f});
  microwave.add(box({0.02f, pw, ph}), print,
                at(front + 0.004f, width / 2 - 0.008f - pw / 2, foot + 0.006f));
  return std::move(microwave).finish();
}

namespace {

Model round_fruit(std::string_view class_name, float radius, float flat, float dent,
                  std::span<const std::uint32_t> colours, bool stalk, Dice& dice) {
  Assembly fruit(class_name, Symmetry::kAnyTurn);
  Canvas skin(0.1f, 0.1f, 3000, dice.colour(colours));
  if (stalk) skin.grain(0.3f, 0.01f, 0.05f, dice.seed());
  skin.grain(0.15f, 0.002f, 0.002f, dice.seed());
  const auto peel =
      fruit.material({.colour = Colour::Ones(), .texture = skin.texture(), .gloss = 0.35f});
  const auto wooden = fruit.material({.colour = srgb(0x3d2a18)});
  Mesh body = ball(radius, 28);
  deform(
      body,
      [&](const Eigen::Vector3f& p) {
        const float up = p.z() / radius - 1, r = p.head<2>().norm() / radius;
        const float sunk = dent * std::exp(-18 * r * r) * radius * (up > 0 ? 1.0f : -0.7f);
        const float wide = 1 + 0.06f * up;
        return Eigen::Vector3f(p.x() * wide, p.y() * wide,
                               (p.z() - radius) * flat + radius * flat - sunk);
      },
      75);
  fruit.add(body, peel);
  if (stalk) {
    const float top = 2 * radius * flat - dent * radius;
    fruit.add(tube({{0, 0, top - 0.004f}, {0.001f, 0, top + 0.006f}, {0.004f, 0, top + 0.016f}},
                   0.0013f, 6),
              wooden);
  }
  return std::move(fruit).finish();
}

}  // namespace

Model make_apple(Dice& dice) {
  constexpr std::uint32_t kColours[] = {0xb3202a, 0x9c1b26, 0x8fae3a, 0xc9b13c, 0xc4423a};
  const float radius = dice.uniform(0.034f, 0.043f), flat = dice.uniform(0.86f, 0.98f);
  return round_fruit("apple", radius, flat, dice.uniform(0.18f, 0.3f), kColours, true, dice);
}

Model make_orange(Dice& dice) {
  constexpr std::uint32_t kColours[] = {0xe8821e, 0xf09a2a, 0xe07514};
  const float radius = dice.uniform(0.033f, 0.042f), flat = dice.uniform(0.92f, 1.0f);
  return round_fruit("orange", radius, flat, dice.uniform(0.02f, 0.06f), kColours, false, dice);
}

Model make_banana(Dice& dice) {
  Assembly banana("banana");
  const float length = dice.uniform(0.16f, 0.2f), bend = dice.uniform(0.9f, 1.5f);
  const float thick = dice.uniform(0.016f, 0.02f), taper = dice.uniform(0.3f, 0.45f);
  Canvas skin(0.12f, 0.2f, 2000, srgb(0xe9c53a) * dice.uniform(0.85f, 1.0f));
  for (int i = 0; i < 60; ++i)
    skin.disc(dice.uniform(0, 0.12f), dice.uniform(0, 0.2f), dice.uniform(0.0003f, 0.0012f),
              srgb(0x6b4a1c));
  const auto peel =
      banana.material({.colour = Colour::Ones(), .texture = skin.texture(), .gloss = 0.15f});
  const auto tip = banana.material({.colour = srgb(0x4a3a1c)});
  const float curve_r = length / bend;
  Path path;
  std::vector<float> scales;
  const auto on_arc = [&](float t) {
    const float angle = bend * t;
    return Eigen::Vector3f(curve_r * (std::cos(angle) - 1), curve_r * std::sin(angle), thick);
  };
  for (const float t : evenly(-0.5f, 0.5f, 15)) {
    path.push_back(on_arc(t));
    const float to_end = 2 * std::abs(t);
    scales.push_back(1 - (1 - taper) * std::pow(to_end, 4.0f));
  }
  banana.add(sweep(path, circle(thick, 6), scales, Eigen::Vector3f::UnitZ(), 66), peel);
  banana.add(sweep({on_arc(0.49f), on_arc(0.53f), on_arc(0.6f)}, circle(0.3f * thick, 8),
                   std::vector<float>{1.3f, 0.9f, 1}),
             peel);
  banana.add(ball(taper * thick, 10), tip,
             at(on_arc(-0.5f).x(), on_arc(-0.5f).y(), thick * (1 - taper)));
  return std::move(banana).finish();
}

Model make_remote(Dice& dice) {
  Assembly remote("remote");
  const float length = dice.uniform(0.14f, 0.21f), width = dice.uniform(0.038f, 0.05f);
  const float thick = dice.uniform(0.016f, 0.022f);
  const Colour colour = dice.colour(kPlastics);
  const auto shell = remote.material({.colour = colour, .gloss = 0.25f});
  remote.add(box({length, width, thick}, {.radius = 0.007f, .steps = 2}), shell);
  const auto soft = remote.material(
      {.colour = Colour::Constant(colour.mean() < 0.2f ? 0.22f : 0.05f), .gloss = 0.1f});
  const auto red = remote.material({.colour = srgb(0xc0202a), .gloss = 0.1f});
  const auto put = [&](float x, float y, float size, std::uint32_t material) {
    remote.add(tapered_box({size, size}, {0.85f * size, 0.85f * size}, 0.002f), material,
               at(x, y, thick - 0.0003f));
  };
  put(-0.43f * length, -0.3f * width, 0.008f, red);
  const int rows = 5 + dice.below(4);
  for (const float x : evenly(-0.33f * length, 0.08f * length, rows))
    for (const float y : {-0.3f * width, 0.0f, 0.3f * width}) put(x, y, 0.007f, soft);
  remote.add(extrude(circle(0.32f * width, 20), 0.0022f, 0.0006f), soft,
             at(0.24f * length, 0, thick - 0.0003f));
  for (const float y : {-0.3f * width, 0.3f * width}) put(0.4f * length, y, 0.008f, soft);
  return std::move(remote).finish();
}

}  // namespace cairn
