#include <algorithm>
#include <cmath>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

const Eigen::Vector3f kAcross = Eigen::Vector3f::UnitY();
constexpr float kPi = 3.14159265f;

Print clock_face(float radius, const Colour& ground, const Colour& ink, Dice& dice) {
  Canvas face(2 * radius, 2 * radius, 2000, ground);
  const bool numbers = dice.chance(0.7f);
  for (int i = 0; i < 60; ++i) {
    const float angle = kPi / 30 * float(i), out = 0.95f * radius;
    const float in = radius * (i % 5 ? 0.91f : 0.86f), x = std::sin(angle), y = -std::cos(angle);
    face.line(radius + in * x, radius + in * y, radius + out * x, radius + out * y,
              radius * (i % 5 ? 0.012f : 0.03f), ink);
    if (numbers && i % 5 == 0) {
      const std::string hour = std::to_string(i == 0 ? 12 : i / 5);
      const float tall = 0.15f * radius;
      face.text(hour, radius * (1 + 0.72f * x), radius * (1 + 0.72f * y) + tall / 2, tall, ink,
                {.centred = true});
    }
  }
  const float hour = dice.uniform(0, 12), minute = hour - std::floor(hour);
  const auto hand = [&](float turns, float length, float thick) {
    const float x = std::sin(2 * kPi * turns), y = -std::cos(2 * kPi * turns);
    face.line(radius * (1 - 0.15f * x), radius * (1 - 0.15f * y), radius * (1 + length * x),
              radius * (1 + length * y), thick * radius, ink);
  };
  hand(hour / 12, 0.5f, 0.06f);
  hand(minute, 0.78f, 0.04f);
  face.disc(radius, radius, 0.06f * radius, ink);
  return face.texture();
}

}  // namespace

// Round, of the kind that hangs on a wall or stands on a desk; its dial to the front.
Model make_clock(Dice& dice) {
  Assembly clock("clock");
  const bool on_desk = dice.chance(0.35f);
  const float radius = on_desk ? dice.uniform(0.05f, 0.08f) : dice.uniform(0.11f, 0.18f);
  const float thick = radius * dice.uniform(0.2f, 0.4f), rim = radius * dice.uniform(0.06f, 0.12f);
  const Colour ground = dice.chance(0.75f) ? srgb(0xf4f2ec) : srgb(0x1c1d1f);
  const Colour ink = Colour::Constant(ground.mean() > 0.3f ? 0.01f : 0.8f);
  const auto housing = clock.material(
      {.colour = dice.chance(0.5f) ? dice.colour(kMetals) : dice.colour(kWoods), .gloss = 0.4f});
  const auto dial = clock.material(
      {.colour = Colour::Ones(), .texture = clock_face(radius - rim, ground, ink, dice)});
  const ProfilePoint ring[] = {{0, 0},
                               {radius - 0.3f * rim, 0},
                               {radius, 0.3f * thick},
                               {radius, 0.85f * thick},
                               {radius - 0.4f * rim, thick},
                               {radius - rim, thick},
                               {radius - 1.05f * rim, 0.8f * thick},
                               {0, 0.8f * thick}};
  // Built lying, its dial up; then turned to the front.
  const auto upright = turned(kAcross, 90);
  clock.add(lathe(ring, 48), housing, upright);
  clock.add(extrude(circle(radius - 1.05f * rim, 48), 0.001f), dial,
            upright * at(0, 0, 0.8f * thick));
  if (on_desk)
    for (const float side : {-1.0f, 1.0f})
      clock.add(tube({{thick * 0.5f, side * 0.5f * radius, -0.7f * radius},
                      {thick * 0.5f, side * 0.75f * radius, -1.12f * radius}},
                     0.08f * radius),
                housing);
  return std::move(clock).finish();
}

// A trolley case that stands.
Model make_suitcase(Dice& dice) {
  Assembly suitcase("suitcase");
  const float height = dice.uniform(0.48f, 0.72f), width = height * dice.uniform(0.64f, 0.72f);
  const float deep = width * dice.uniform(0.48f, 0.58f), wheel = 0.028f;
  constexpr std::uint32_t kShells[] = {0x1c1d1f, 0x2d3a4a, 0x8e1f2c, 0x1b6f6a,
                                       0xb9bcc0, 0xe0a030, 0x5a4a78};
  const Colour colour = dice.colour(kShells);
  const bool hard = dice.chance(0.6f);
  const auto shell =
      suitcase.material(hard ? Material{.colour = colour, .gloss = 0.45f}
                             : Material{.colour = Colour::Ones(), .texture = fabric(colour, dice)});
  const auto dark = suitcase.material({.colour = Colour::Constant(0.012f), .gloss = 0.2f});
  const auto metal = suitcase.material({.colour = srgb(0xa8abae), .gloss = 0.6f});
  const float z = 2 * wheel;
  suitcase.add(box({deep, width, height}, {.radius = 0.05f, .steps = 3}), shell, at(0, 0, z));
  suitcase.add(box({0.012f, width + 0.004f, height + 0.004f}, {.radius = 0.005f}), dark,
               at(0, 0, z - 0.002f));
  if (hard) {
    const int ribs = 4 + dice.below(4);
    for (const float y : evenly(-0.36f * width, 0.36f * width, ribs))
      suitcase.add(box({deep + 0.012f, 0.022f, height - 0.14f}, {.radius = 0.006f}), shell,
                   at(0, y, z + 0.07f));
  } else {
    suitcase.add(cushion({0.05f, 0.8f * width, 0.36f * height}, 0.018f, 0.008f), shell,
                 at(deep / 2 + 0.01f, 0, z + 0.08f));
    suitcase.add(cushion({0.05f, 0.8f * width, 0.3f * height}, 0.018f, 0.008f), shell,
                 at(deep / 2 + 0.01f, 0, z + 0.55f * height));
  }
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f}) {
      const float x = sx * (deep / 2 - 0.04f), y = sy * (width / 2 - 0.05f);
      suitcase.add(extrude(circle(wheel, 14), 0.03f, 0.006f), dark,
                   at(x, y + 0.015f, wheel) * turned(Eigen::Vector3f::UnitX(), 90));
      suitcase.add(tapered_box({0.04f, 0.045f}, {0.06f, 0.06f}, wheel), dark, at(x, y, wheel));
    }
  const float top = z + height;
  suitcase.add(tube(round_corners({{0, -0.09f, top - 0.005f},
                                   {0, -0.08f, top + 0.035f},
                                   {0, 0.08f, top + 0.035f},
                                   {0, 0.09f, top - 0.005f}},
                                  0.03f),
                    0.009f),
               dark);
  const float out = dice.chance(0.5f) ? dice.uniform(0.2f, 0.4f) : 0.03f, x = -deep / 2 + 0.03f;
  for (const float side : {-1.0f, 1.0f})
    suitcase.add(tube({{x, side * 0.1f, top - 0.05f}, {x, side * 0.1f, top + out}}, 0.007f), metal);
  suitcase.add(box({0.03f, 0.25f, 0.028f}, {.radius = 0.01f, .steps = 2}), dark,
               at(x, 0, top + out));
  return std::move(suitcase).finish();
}

// It stands, its pockets to the front, its straps at the back.
Model make_backpack(Dice& dice) {
  Assembly backpack("backpack");
  const float height = dice.uniform(0.4f, 0.52f), width = height * dice.uniform(0.6f, 0.72f);
  const float deep = width * dice.uniform(0.45f, 0.6f), round = dice.uniform(0.25f, 0.6f);
  const auto cloth =
      backpack.material({.colour = Colour::Ones(), .texture = fabric(dice.colour(kFabrics), dice)});
  const auto pocket =
      backpack.material({.colour = Colour::Ones(), .texture = fabric(dice.colour(kFabrics), dice)});
  const auto dark = backpack.material({.colour = Colour::Constant(0.015f), .gloss = 0.1f});
  const auto sack = [&](const Eigen::Vector3f& size, float radius) {
    Mesh mesh = cushion(size, radius, 0.01f);
    deform(
        mesh,
        [&](const Eigen::Vector3f& p) {  // narrower and rounder towards the top
          const float up = p.z() / size.z(), high = std::max(0.0f, up - 0.6f) / 0.4f;
          const float across = 2 * p.y() / size.y();
          const float shrink = 1 - 0.28f * high * high;
          return Eigen::Vector3f(p.x() * shrink, p.y() * (1 - 0.2f * high * high),
                                 p.z() - round * 0.16f * size.z() * across * across * high);
        },
        75);
    return mesh;
  };
  backpack.add(sack({deep, width, height}, 0.07f), cloth);
  backpack.add(sack({0.1f, 0.8f * width, 0.48f * height}, 0.045f), pocket,
               at(deep / 2 + 0.015f, 0, 0.03f));
  if (dice.chance(0.6f))
    backpack.add(sack({0.06f, 0.66f * width, 0.2f * height}, 0.028f), pocket,
                 at(deep / 2 - 0.005f, 0, 0.56f * height));
  for (const float side : {-1.0f, 1.0f})
    backpack.add(sack({0.7f * deep, 0.07f, 0.36f * height}, 0.032f), pocket,
                 at(-0.05f * deep, side * (width / 2 + 0.005f), 0.02f));
  const auto zip = [&](float z, float wide, float x, float drop) {
    Path path;
    for (const float t : evenly(-1, 1, 13))
      path.emplace_back(x - 0.012f * t * t, t * wide, z - drop * t * t);
    backpack.add(tube(path, 0.004f, 6), dark);
  };
  zip(0.48f * height, 0.34f * width, deep / 2 + 0.064f, 0.06f);
  // Around the main compartment, from side to side over the top.
  Path mouth;
  for (const float t : evenly(-1, 1, 21)) {
    const float angle = 1.5708f * t, shrink = 1 - 0.2f * std::cos(angle);
    mouth.emplace_back(0.2f * deep, 1.04f * (width / 2) * std::sin(angle) * shrink / 0.98f,
                       (0.35f + 0.665f * std::pow(std::max(0.0f, std::cos(angle)), 0.6f)) * height);
  }
  backpack.add(tube(mouth, 0.006f, 6), dark);
  const float top = height;
  backpack.add(tube(round_corners({{-0.04f, -0.04f, top - 0.03f},
                                   {-0.04f, -0.04f, top + 0.05f},
                                   {-0.04f, 0.04f, top + 0.05f},
                                   {-0.04f, 0.04f, top - 0.03f}},
                                  0.04f),
                    0.009f),
               dark);
  for (const float side : {-1.0f, 1.0f}) {
    const float y = side * 0.26f * width, back = -deep / 2;
    const Path strap{{back + 0.02f, y, 0.9f * height},
                     {back - 0.03f, y * 1.05f, 0.86f * height},
                     {back - 0.06f, y * 1.2f, 0.6f * height},
                     {back - 0.05f, y * 1.45f, 0.3f * height},
                     {back + 0.02f, y * 1.6f, 0.06f * height}};
    backpack.add(sweep(smooth(strap, 4), ellipse(0.033f, 0.008f, 10)), dark);
  }
  return std::move(backpack).finish();
}

Model make_sports_ball(Dice& dice) {
  Assembly thing("sports ball", Symmetry::kAnyTurn);
  const int kind = dice.below(3);
  const float radius = kind == 0   ? dice.uniform(0.104f, 0.112f)
                       : kind == 1 ? dice.uniform(0.115f, 0.122f)
                                   : dice.uniform(0.1f, 0.107f);
  const Colour ground = kind == 1           ? srgb(0xd2691e)
                        : dice.chance(0.7f) ? srgb(0xf3f3f0)
                                            : dice.colour(kPrints);
  const Colour ink = kind == 1 || dice.chance(0.6f) ? srgb(0x151515) : dice.colour(kPrints);
  std::vector<Eigen::Vector3f> corners;  // of an icosahedron: the football's pentagons
  const float golden = 1.618034f;
  for (const float a : {-1.0f, 1.0f})
    for (const float b : {-golden, golden})
      for (const Eigen::Vector3f& p : {Eigen::Vector3f(0, a, b), {a, b, 0}, {b, 0, a}})
        corners.push_back(p.normalized());
  const Eigen::Matrix3f tilt = turned({1, 2, 0.5f}, dice.uniform(0, 360)).linear();
  Canvas skin(2 * kPi * radius, kPi * radius, 1500, ground);
  skin.paint([&](float x, float y) -> Colour {
    const float azimuth = x / radius, polar = y / radius;
    const Eigen::Vector3f d =
        tilt * Eigen::Vector3f(std::cos(azimuth) * std::sin(polar),
                               std::sin(azimuth) * std::sin(polar), std::cos(polar));
    if (kind == 0) {
      float best = -1, second = -1;
      for (const Eigen::Vector3f& corner : corners) {
        const float c = d.dot(corner);
        if (c > best)
          std::swap(best, second), best = c;
        else
          second = std::max(second, c);
      }
      return best > 0.94f || best - second < 0.008f ? ink : ground;
    }
    if (kind == 1) {
      const float bow = std::abs(d.y()) - 0.55f - 0.35f * d.x() * d.x();
      return std::min({std::abs(d.x()), std::abs(d.z()), std::abs(bow)}) < 0.02f ? ink : ground;
    }
    // A volleyball's bands.
    const Eigen::Vector3f a = d.cwiseAbs();
    const int axis = a.x() > a.y() ? (a.x() > a.z() ? 0 : 2) : (a.y() > a.z() ? 1 : 2);
    const float band = d[(axis + 1) % 3] / a[axis];
    if (std::abs(std::abs(band) - 0.33f) < 0.025f || std::abs(band) > 0.975f) return srgb(0x404040);
    return band > 0.33f ? ink : ground;
  });
  const auto leather =
      thing.material({.colour = Colour::Ones(), .texture = skin.texture(), .gloss = 0.2f});
  thing.add(ball(radius, 40), leather);
  return std::move(thing).finish();
}

}  // namespace cairn
