#include <cmath>
#include <numbers>

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
const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

void add_star_base(Assembly& chair, float radius, float seat_z, std::uint32_t frame) {
  for (int i = 0; i < 5; ++i) {
    const auto spoke = turned(kUp, 72 * float(i) + 18);
    const Path path{{0.02f, 0, 0.1f}, {0.5f * radius, 0, 0.095f}, {radius, 0, 0.065f}};
    chair.add(sweep(path, rounded_rectangle(0.045f, 0.03f, 0.008f, 2),
                    std::vector<float>{1.1f, 0.9f, 0.6f}),
              frame, spoke);
    const Mesh castor = extrude(circle(0.028f, 14), 0.04f, 0.006f);
    chair.add(castor, frame,
              spoke * at(radius, 0.02f, 0.028f) * turned(Eigen::Vector3f::UnitX(), 90));
  }
  const ProfilePoint column[] = {{0, 0.06f},
                                 {0.035f, 0.06f},
                                 {0.035f, 0.13f},
                                 {0.025f, 0.14f},
                                 {0.025f, seat_z - 0.06f},
                                 {0.08f, seat_z - 0.02f},
                                 {0.08f, seat_z},
                                 {0, seat_z}};
  chair.add(lathe(column, 16), frame);
}

Model office_chair(Dice& dice) {
  Assembly chair("chair");
  const Colour cloth = dice.chance(0.5f) ? srgb(0x1f2124) : dice.colour(kFabrics);
  const auto fabric_material =
      chair.material({.colour = Colour::Ones(), .texture = fabric(cloth, dice)});
  const Colour metal = dice.chance(0.7f) ? srgb(0x1c1d1f) : dice.colour(kMetals);
  const auto frame = chair.material({.colour = metal, .gloss = 0.3f});
  const float seat_z = dice.uniform(0.42f, 0.5f), width = dice.uniform(0.46f, 0.54f);
  const float deep = dice.uniform(0.46f, 0.52f), back = dice.uniform(0.42f, 0.66f);
  const float lean = dice.uniform(6, 14), back_z = seat_z + dice.uniform(0.1f, 0.18f);

  add_star_base(chair, dice.uniform(0.28f, 0.33f), seat_z, frame);
  chair.add(cushion({deep, width, 0.09f}, 0.035f, 0.012f), fabric_material, at(0.02f, 0, seat_z));
  Mesh rest = cushion({0.075f, width * 0.94f, back}, 0.03f, 0.012f);
  deform(
      rest,
      [&](const Eigen::Vector3f& p) {  // it embraces the back
        const float across = 2 * p.y() / width;
        return Eigen::Vector3f(p.x() + 0.05f * across * across, p.y() * (1 - 0.12f * p.z() / back),
                               p.z());
      },
      70);
  chair.add(rest, fabric_material, at(-deep / 2 + 0.01f, 0, back_z) * turned(kAcross, -lean));
  const Path spine{{-0.05f, 0, seat_z - 0.01f},
                   {-deep / 2 - 0.06f, 0, seat_z - 0.005f},
                   {-deep / 2 - 0.075f, 0, back_z + 0.25f * back}};
  chair.add(sweep(round_corners(spine, 0.06f), rounded_rectangle(0.07f, 0.02f, 0.006f, 2)), frame);
  if (dice.chance(0.65f)) {
    for (const float side : {-1.0f, 1.0f}) {
      const float y = side * (width / 2 + 0.03f);
      const Path post{{0.02f, side * 0.3f * width, seat_z + 0.005f},
                      {0.02f, y, seat_z + 0.005f},
                      {0.0f, y, seat_z + 0.22f}};
      chair.add(tube(round_corners(post, 0.05f), 0.014f), frame);
      chair.add(box({0.25f, 0.06f, 0.03f}, {.radius = 0.012f, .steps = 2}), frame,
                at(0.02f, y, seat_z + 0.21f));
    }
  }
  return std::move(chair).finish();
}

Model four_legged_chair(Dice& dice) {
  Assembly chair("chair");
  const bool wooden = dice.chance(0.65f);
  const Colour colour = wooden ? dice.colour(kWoods) : dice.colour(kMetals);
  const auto frame = chair.material(wooden ? Material{.colour = Colour::Ones(),
                                                      .texture = wood(0.5f, 1, colour, dice),
                                                      .gloss = 0.15f}
                                           : Material{.colour = colour, .gloss = 0.4f});
  const auto soft =
      chair.material({.colour = Colour::Ones(), .texture = fabric(dice.colour(kFabrics), dice)});
  const float seat_z = dice.uniform(0.42f, 0.47f), top = dice.uniform(0.8f, 1.0f);
  const float width = dice.uniform(0.4f, 0.48f), deep = dice.uniform(0.4f, 0.46f);
  const float leg = wooden ? dice.uniform(0.028f, 0.042f) : dice.uniform(0.018f, 0.026f);
  const float splay = dice.uniform(0.0f, 0.05f), rake = dice.uniform(0.04f, 0.1f);
  const Outline section =
      dice.chance(0.5f) ? circle(leg / 2, 10) : rounded_rectangle(leg, leg, 0.15f * leg, 1);
  const float x = deep / 2 - leg / 2, y = width / 2 - leg / 2;
  for (const float side : {-1.0f, 1.0f}) {
    const Path front{{x + splay, side * (y + splay), 0}, {x, side * y, seat_z}};
    chair.add(sweep(front, section, std::vector<float>{0.8f, 1}), frame);
    const Path back{
        {-x - splay, side * (y + splay), 0}, {-x, side * y, seat_z}, {-x - rake, side * y, top}};
    chair.add(sweep(back, section), frame);
    chair.add(box({deep - 2 * leg, 0.02f, 0.05f}), frame, at(0, side * y, seat_z - 0.06f));
  }
  chair.add(box({deep, width, 0.02f}, {.radius = 0.005f}), frame, at(0, 0, seat_z - 0.01f));
  if (dice.chance(0.6f))
    chair.add(cushion({deep * 0.96f, width * 0.96f, 0.045f}, 0.02f, 0.008f), soft,
              at(0, 0, seat_z + 0.005f));
  // The back: rails, slats or a panel between the posts, which lean back.
  const auto on_back = [&](float z) { return at(-x - rake * (z - seat_z) / (top - seat_z), 0, z); };
  const float lean = std::atan2(rake, top - seat_z) * 180 / std::numbers::pi_v<float>;
  const auto leaning = turned(kAcross, -lean);
  const float inner = 2 * y;
  const int kind = dice.below(3);
  if (kind == 0) {
    const int rails = 2 + dice.below(3);
    for (const float z : evenly(seat_z + 0.14f, top - 0.08f, rails))
      chair.add(box({0.018f, inner, 0.055f}, {.radius = 0.005f}), frame, on_back(z) * leaning);
  } else if (kind == 1) {
    chair.add(box({0.025f, inner, 0.06f}, {.radius = 0.006f}), frame,
              on_back(top - 0.06f) * leaning);
    chair.add(box({0.02f, inner, 0.03f}), frame, on_back(seat_z + 0.08f) * leaning);
    const int slats = 4 + dice.below(4);
    for (const float across : evenly(-0.4f * inner, 0.4f * inner, slats))
      chair.add(box({0.012f, 0.02f, top - seat_z - 0.13f}), frame,
                on_back(seat_z + 0.09f) * leaning * at(0, across, 0));
  } else {
    chair.add(cushion({0.04f, inner * 0.98f, 0.6f * (top - seat_z)}, 0.015f, 0.004f), soft,
              on_back(seat_z + 0.36f * (top - seat_z)) * leaning);
  }
  return std::move(chair).finish();
}

}  // namespace

Model make_chair(Dice& dice) {
  return dice.chance(0.5f) ? office_chair(dice) : four_legged_chair(dice);
}

}  // namespace cairn
