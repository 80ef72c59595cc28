#include <cmath>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"

namespace cairn {
namespace {

const Eigen::Vector3f kAcross = Eigen::Vector3f::UnitY();
const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

void add_pole(Assembly& thing, float radius, float height, std::uint32_t metal) {
  const ProfilePoint pole[] = {{0, 0},          {2.2f * radius, 0}, {2.2f * radius, 0.02f},
                               {radius, 0.05f}, {radius, height},   {0, height}};
  thing.add(lathe(pole, 16), metal);
}

}  // namespace

Model make_traffic_light(Dice& dice) {
  Assembly light("traffic light");
  const float pole_h = dice.uniform(2.2f, 3.2f), pole_r = dice.uniform(0.04f, 0.06f);
  const float lens = dice.uniform(0.09f, 0.12f), pitch = 2.5f * lens;
  const float wide = 2.9f * lens, deep = dice.uniform(0.14f, 0.2f);
  const Colour colour = dice.chance(0.3f) ? srgb(0xd9a520) : srgb(0x1b1d1e);
  const auto metal = light.material({.colour = dice.colour(kMetals), .gloss = 0.3f});
  const auto housing = light.material({.colour = colour, .gloss = 0.2f});
  const auto dark = light.material({.colour = Colour::Constant(0.01f)});
  add_pole(light, pole_r, pole_h + 3 * pitch, metal);
  const float x = pole_r + 0.03f + deep / 2;
  light.add(box({deep, wide, 3.15f * pitch}, {.radius = 0.02f, .steps = 2}), housing,
            at(x, 0, pole_h));
  if (dice.chance(0.5f))
    light.add(box({0.01f, 1.5f * wide, 3.6f * pitch}, {.radius = 0.004f}), dark,
              at(x, 0, pole_h - 0.22f * pitch));
  for (const float z : {pole_h + 0.6f * pitch, pole_h + 2.5f * pitch})
    light.add(box({0.08f, 0.04f, 0.04f}), metal, at(pole_r + 0.01f, 0, z));
  const int lit = dice.below(3);
  constexpr std::uint32_t kLenses[] = {0x23d18b, 0xffb11b, 0xff2a1f};  // from below
  for (int i = 0; i < 3; ++i) {
    const Colour glow = srgb(kLenses[i]);
    const auto glass = light.material({.colour = glow * (i == lit ? 0.6f : 0.18f),
                                       .gloss = 0.5f,
                                       .emission = glow * (i == lit ? 1.6f : 0.0f)});
    const auto place =
        at(x + deep / 2, 0, pole_h + (float(i) + 0.575f) * pitch) * turned(kAcross, 90);
    const ProfilePoint dome[] = {
        {0, -0.01f}, {lens, -0.01f}, {lens, 0.004f}, {0.7f * lens, 0.02f}, {0, 0.028f}};
    light.add(lathe(dome, 24), glass, place);
    // The hood over the lens: three quarters of a tube.
    Outline arc;
    for (const float a : evenly(-0.72f * 3.1416f, 0.72f * 3.1416f, 17))
      arc.emplace_back(-1.12f * lens * std::cos(a), 1.12f * lens * std::sin(a));
    for (const float a : evenly(0.72f * 3.1416f, -0.72f * 3.1416f, 17))
      arc.emplace_back(-1.07f * lens * std::cos(a), 1.07f * lens * std::sin(a));
    std::reverse(arc.begin(), arc.end());
    light.add(extrude(arc, 1.3f * lens), dark, place);
  }
  return std::move(light).finish();
}

Model make_stop_sign(Dice& dice) {
  Assembly sign("stop sign");
  const float radius = dice.uniform(0.36f, 0.46f), pole_h = dice.uniform(2.0f, 2.7f);
  const float pole_r = dice.uniform(0.025f, 0.04f), edge = dice.uniform(0.03f, 0.05f);
  const auto metal = sign.material({.colour = dice.colour(kMetals), .gloss = 0.4f});
  Outline octagon;
  for (int i = 0; i < 8; ++i) {
    const float a = 0.785398f * (float(i) + 0.5f);
    octagon.emplace_back(radius * std::cos(a), radius * std::sin(a));
  }
  const float half = radius * std::cos(0.392699f);
  Canvas face(2 * half, 2 * half, 700, srgb(0xf4f4f2));
  std::vector<Eigen::Vector2f> inner;
  for (const Eigen::Vector2f& p : octagon)
    inner.emplace_back(half + (1 - edge / half) * p.x(), half + (1 - edge / half) * p.y());
  face.polygon(inner, srgb(0xb5121b) * dice.uniform(0.8f, 1.0f));
  const float tall = 0.5f * half;
  face.text("STOP", half, half + 0.5f * tall, tall, srgb(0xf4f4f2),
            {.thickness = 0.22f, .max_width = 1.5f * half, .centred = true});
  const auto print =
      sign.material({.colour = Colour::Ones(), .texture = face.texture(), .gloss = 0.3f});
  add_pole(sign, pole_r, pole_h + 0.3f * radius, metal);
  const auto place = at(pole_r + 0.004f, 0, pole_h) * turned(kAcross, 90);
  sign.add(extrude(octagon, 0.003f), metal, place);
  sign.add(extrude(octagon, 0.002f), print, place * at(0, 0, 0.003f));
  return std::move(sign).finish();
}

Model make_fire_hydrant(Dice& dice) {
  Assembly hydrant("fire hydrant");
  const float height = dice.uniform(0.62f, 0.82f), radius = height * dice.uniform(0.13f, 0.165f);
  constexpr std::uint32_t kPaints[] = {0xb5231f, 0xc23a1e, 0xe0b020, 0x8f1a1a, 0x2a5f9e};
  const Colour colour = dice.colour(kPaints);
  const auto paint = hydrant.material({.colour = colour, .gloss = 0.35f});
  const auto caps =
      hydrant.material({.colour = dice.chance(0.5f) ? colour : srgb(0xcfd2d4), .gloss = 0.4f});
  const float r = radius, h = height;
  const Profile profile{{0, 0, 0},
                        {1.5f * r, 0, 0},
                        {1.5f * r, 0.04f * h, 0},
                        {1.02f * r, 0.05f * h, 0},
                        {r, 0.1f * h, 0},
                        {0.97f * r, 0.58f * h, 0},
                        {1.25f * r, 0.6f * h, 0},
                        {1.25f * r, 0.65f * h, 0},
                        {1.05f * r, 0.66f * h, 0},
                        {1.05f * r, 0.7f * h, 1},
                        {1.28f * r, 0.71f * h, 1},
                        {1.28f * r, 0.75f * h, 1},
                        {1.05f * r, 0.8f * h, 1},
                        {0.75f * r, 0.88f * h, 1},
                        {0.3f * r, 0.93f * h, 1},
                        {0.22f * r, 0.94f * h, 1},
                        {0.22f * r, h, 1},
                        {0, h, 1}};
  hydrant.add(lathe(profile, 28), {paint, caps});
  const ProfilePoint outlet[] = {{0, 0},
                                 {0.5f * r, 0},
                                 {0.5f * r, 1.35f * r},
                                 {0.62f * r, 1.36f * r},
                                 {0.62f * r, 1.7f * r},
                                 {0.2f * r, 1.75f * r},
                                 {0.2f * r, 1.95f * r},
                                 {0, 1.95f * r}};
  for (const float azimuth : {90.0f, -90.0f})
    hydrant.add(lathe(outlet, 16), caps,
                at(0, 0, 0.5f * h) * turned(kUp, azimuth) * turned(kAcross, 90));
  const ProfilePoint pumper[] = {{0, 0},
                                 {0.7f * r, 0},
                                 {0.7f * r, 1.2f * r},
                                 {0.85f * r, 1.21f * r},
                                 {0.85f * r, 1.5f * r},
                                 {0.2f * r, 1.55f * r},
                                 {0.2f * r, 1.75f * r},
                                 {0, 1.75f * r}};
  hydrant.add(lathe(pumper, 20), caps, at(0, 0, 0.42f * h) * turned(kAcross, 90));
  return std::move(hydrant).finish();
}

}  // namespace cairn
