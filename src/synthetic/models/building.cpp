#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"

// What belongs to a room rather than standing in it. All of it is meant to stand before a wall, or
// a little inside of it, with its front into the room.

namespace cairn {
namespace {

const Eigen::Vector3f kAcross = Eigen::Vector3f::UnitY();

// Three or four bars around an opening of the given size, which starts at `z`.
void add_frame(Assembly& thing, float width, float height, float z, float bar, float deep,
               bool sill, std::uint32_t material) {
  const BoxOptions edge{.radius = 0.004f};
  for (const float side : {-1.0f, 1.0f})
    thing.add(box({deep, bar, height + bar + (sill ? bar : 0)}, edge), material,
              at(0, side * (width + bar) / 2, z - (sill ? bar : 0)));
  thing.add(box({deep, width + 2 * bar, bar}, edge), material, at(0, 0, z + height));
  if (sill) thing.add(box({deep, width + 2 * bar, bar}, edge), material, at(0, 0, z - bar));
}

void add_lever(Assembly& door, float y, float z, float x, float towards, std::uint32_t metal) {
  door.add(box({0.008f, 0.045f, 0.2f}, {.radius = 0.003f}), metal, at(x, y, z - 0.1f));
  const Path lever{
      {x, y, z + 0.04f}, {x + 0.05f, y, z + 0.04f}, {x + 0.05f, y + towards * 0.12f, z + 0.04f}};
  door.add(tube(round_corners(lever, 0.02f), 0.009f), metal);
}

}  // namespace

Model make_door(Dice& dice) {
  Assembly door("door");
  const float width = dice.uniform(0.78f, 0.96f), height = dice.uniform(1.98f, 2.1f);
  const float bar = dice.uniform(0.05f, 0.09f), leaf = 0.04f,
              side = dice.chance(0.5f) ? 1.0f : -1.0f;
  const bool painted = dice.chance(0.5f);
  const Colour colour = painted ? dice.colour(kGlazes) : dice.colour(kWoods);
  const auto surface = door.material(painted ? Material{.colour = colour, .gloss = 0.15f}
                                             : Material{.colour = Colour::Ones(),
                                                        .texture = wood(1, 2, colour, dice),
                                                        .gloss = 0.15f});
  const auto frame =
      door.material({.colour = painted ? srgb(0xdad7d0) : Colour(colour * 0.8f), .gloss = 0.1f});
  const auto metal = door.material({.colour = dice.colour(kMetals), .gloss = 0.6f});
  const auto glass = door.material({.colour = srgb(0x9fb2ba), .gloss = 0.8f});
  add_frame(door, width, height, 0, bar, 0.09f, false, frame);
  door.add(box({leaf, width, height - 0.005f}), surface, at(0.015f, 0, 0.005f));
  const float front = 0.015f + leaf / 2;
  const int kind = dice.below(3);
  const int panels = 2 + dice.below(2);
  if (kind == 0)
    for (int i = 0; i < panels; ++i) {
      const float tall = (height - 0.3f) / float(panels);
      const float z = 0.15f + float(i) * tall;
      door.add(box({0.016f, width - 0.26f, tall - 0.1f}, {.radius = 0.007f}), surface,
               at(front, 0, z + 0.05f));
    }
  if (kind == 1)
    door.add(box({0.004f, 0.18f * width, 0.55f * height}), glass,
             at(front, -side * 0.05f, 0.35f * height));
  add_lever(door, side * (width / 2 - 0.07f), 1.03f, front, -side, metal);
  const float plate = dice.uniform(0.1f, 0.16f);
  Canvas sign(plate, 0.6f * plate, 2000, srgb(0xf0f0ee));
  sign.text(std::to_string(100 + dice.below(400)), 0.1f * plate, 0.42f * plate, 0.26f * plate,
            Colour::Constant(0.02f), {.max_width = 0.8f * plate});
  if (dice.chance(0.6f))
    door.add(box({0.004f, plate, 0.6f * plate}),
             door.material({.colour = Colour::Ones(), .texture = sign.texture()}),
             at(front + 0.002f, 0, 1.55f));
  return std::move(door).finish();
}

// With a bright sky and a blurred outside behind its panes.
Model make_window(Dice& dice) {
  Assembly window("window");
  const float width = dice.uniform(0.8f, 1.8f), height = dice.uniform(0.9f, 1.5f);
  const float bar = dice.uniform(0.05f, 0.08f);
  const auto frame =
      window.material({.colour = srgb(0xe4e2dc) * dice.uniform(0.5f, 1.0f), .gloss = 0.2f});
  const Colour zenith = srgb(0xa9c9ea), horizon = srgb(0xe8f0f4), ground = srgb(0x6f7f62);
  Canvas view(width, height, 400, zenith);
  const float from = height * dice.uniform(0.55f, 0.8f);
  view.paint([&](float, float y) -> Colour {
    return y < from ? Colour(zenith + (horizon - zenith) * (y / from)) : ground;
  });
  for (int i = 0; i < 8; ++i) {
    const float wide = width * dice.uniform(0.08f, 0.2f),
                top = from - height * dice.uniform(0.05f, 0.4f);
    const float x = width * dice.uniform(-0.1f, 0.95f);
    const Colour far = dice.colour(kGlazes) * 0.4f + horizon * 0.5f;
    if (dice.chance(0.5f))
      view.disc(x, from - 0.02f, wide * 0.7f, Colour(0.06f, 0.12f, 0.05f) + 0.25f * horizon);
    else
      view.rectangle(x, top, wide, from - top + 0.02f, far);
  }
  const auto panes = window.material({.colour = Colour::Constant(0.02f),
                                      .texture = view.texture(),
                                      .gloss = 0.3f,
                                      .emission = Colour::Constant(dice.uniform(0.8f, 1.2f))});
  add_frame(window, width, height, bar, bar, 0.07f, true, frame);
  window.add(box({0.01f, width, height}), panes, at(0, 0, bar));
  const int columns = width > 1.2f ? 2 + dice.below(2) : 1 + dice.below(2);
  for (int i = 1; i < columns; ++i)
    window.add(box({0.05f, 0.05f, height}, {.radius = 0.004f}), frame,
               at(0, width * (float(i) / float(columns) - 0.5f), bar));
  if (dice.chance(0.4f))
    window.add(box({0.04f, width, 0.03f}, {.radius = 0.004f}), frame,
               at(0, 0, bar + 0.65f * height));
  window.add(box({0.2f, width + 4 * bar, 0.03f}, {.radius = 0.006f}), frame, at(0.07f, 0, -0.03f));
  return std::move(window).finish();
}

Model make_poster(Dice& dice) {
  Assembly poster("poster");
  const float height = dice.uniform(0.4f, 1.0f), width = height * dice.uniform(0.65f, 0.8f);
  const auto print = poster.material(
      {.colour = Colour::Ones(), .texture = poster_print(width, height, dice), .gloss = 0.08f});
  poster.add(box({0.003f, width, height}), print);
  if (dice.chance(0.6f)) {  // framed
    const float bar = dice.uniform(0.012f, 0.03f);
    const auto frame = poster.material(
        {.colour = dice.chance(0.5f) ? dice.colour(kWoods) : dice.colour(kMetals), .gloss = 0.2f});
    add_frame(poster, width, height, 0, bar, 0.02f, true, frame);
  }
  return std::move(poster).finish();
}

namespace {

Model lamp(std::string_view class_name, float height, float shade_r, Dice& dice) {
  Assembly lamp(class_name, Symmetry::kAnyTurn);
  const float shade_h = shade_r * dice.uniform(1.0f, 1.5f), taper = dice.uniform(0.55f, 1.0f);
  const float foot = shade_r * dice.uniform(0.65f, 0.9f), rod = height > 1 ? 0.012f : 0.01f;
  const auto stand = lamp.material(
      {.colour = dice.chance(0.5f) ? dice.colour(kMetals) : dice.colour(kGlazes), .gloss = 0.4f});
  const Colour cloth = srgb(0xf1e3c4) * dice.uniform(0.8f, 1.0f);
  const auto shade =
      lamp.material({.colour = cloth, .emission = cloth * dice.uniform(0.25f, 0.7f)});
  Profile points{{0, 0}, {foot, 0}, {foot, 0.015f}, {0.3f * foot, 0.03f}};
  if (height < 1 && dice.chance(0.6f)) {  // a bellied foot
    const float belly = foot * dice.uniform(0.6f, 0.95f);
    const ProfilePoint body[] = {{0.4f * belly, 0.03f},
                                 {belly, 0.3f * (height - shade_h)},
                                 {0.5f * belly, 0.75f * (height - shade_h)},
                                 {rod, height - shade_h}};
    for (const ProfilePoint& p : smooth_profile(body, 5)) points.push_back(p);
  } else {
    points.push_back({rod, 0.04f});
  }
  points.push_back({rod, height - 0.3f * shade_h});
  points.push_back({0, height - 0.3f * shade_h});
  lamp.add(lathe(points, 24), stand);
  const float low = height - shade_h, top_r = taper * shade_r;
  const ProfilePoint screen[] = {{shade_r - 0.004f, low},
                                 {shade_r, low},
                                 {top_r, height},
                                 {top_r - 0.004f, height},
                                 {shade_r - 0.004f, low}};
  lamp.add(lathe(screen, 32), shade);
  lamp.add(ball(0.03f, 12), shade, at(0, 0, height - 0.6f * shade_h));
  return std::move(lamp).finish();
}

}  // namespace

Model make_lamp(Dice& dice) {
  const float height = dice.uniform(0.35f, 0.6f);
  return lamp("lamp", height, height * dice.uniform(0.25f, 0.36f), dice);
}

Model make_floor_lamp(Dice& dice) {
  return lamp("floor lamp", dice.uniform(1.4f, 1.75f), dice.uniform(0.17f, 0.25f), dice);
}

}  // namespace cairn
