#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"

namespace cairn {
namespace {

Model round_table(Dice& dice) {
  Assembly table("dining table", Symmetry::kAnyTurn);
  const float radius = dice.uniform(0.45f, 0.65f), height = dice.uniform(0.71f, 0.77f);
  const float thick = dice.uniform(0.02f, 0.035f), column = dice.uniform(0.035f, 0.06f);
  const auto top =
      table.material({.colour = Colour::Ones(),
                      .texture = wood(2 * radius, 2 * radius, dice.colour(kWoods), dice),
                      .gloss = dice.uniform(0.1f, 0.35f)});
  const auto leg = table.material({.colour = dice.colour(kMetals), .gloss = 0.3f});
  Mesh plate = extrude(circle(radius, 64), thick, 0.004f);
  table.add(plate, top, at(0, 0, height - thick));
  const float foot = radius * dice.uniform(0.5f, 0.65f);
  const ProfilePoint points[] = {{0, 0},
                                 {foot, 0},
                                 {foot, 0.012f},
                                 {0.4f * foot, 0.03f},
                                 {column, 0.1f},
                                 {column, height - thick - 0.06f},
                                 {0.3f * radius, height - thick},
                                 {0, height - thick}};
  table.add(lathe(round_profile(points, 0.05f), 32), leg);
  return std::move(table).finish();
}

}  // namespace

Model make_dining_table(Dice& dice) {
  if (dice.chance(0.2f)) return round_table(dice);
  Assembly table("dining table", Symmetry::kHalfTurn);
  const float width = dice.uniform(1.2f, 2.0f), deep = dice.uniform(0.7f, 0.95f);
  const float height = dice.uniform(0.71f, 0.77f), thick = dice.uniform(0.02f, 0.04f);
  const float leg = dice.uniform(0.045f, 0.08f), set_in = dice.uniform(0.0f, 0.06f);
  const Colour colour = dice.colour(kWoods);
  const auto top = table.material({.colour = Colour::Ones(),
                                   .texture = wood(width, deep, colour, dice),
                                   .gloss = dice.uniform(0.1f, 0.35f)});
  const auto frame =
      table.material(dice.chance(0.6f) ? Material{.colour = Colour::Ones(),
                                                  .texture = wood(0.5f, 1, colour, dice),
                                                  .gloss = 0.15f}
                                       : Material{.colour = dice.colour(kMetals), .gloss = 0.3f});
  table.add(box({deep, width, thick}, {.radius = 0.003f}), top, at(0, 0, height - thick));
  const float x = deep / 2 - leg / 2 - set_in, y = width / 2 - leg / 2 - set_in;
  const int kind = dice.below(3);
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sy : {-1.0f, 1.0f}) {
      const Outline section =
          kind == 2 ? circle(leg / 2, 14) : rounded_rectangle(leg, leg, 0.1f * leg, 1);
      const float splay = kind == 2 ? 0.05f : 0.0f;
      const Path path{{sx * (x - 0.02f + splay), sy * (y - 0.02f + splay), 0},
                      {sx * x, sy * y, height - thick}};
      const std::vector<float> scales{kind == 0 ? 1.0f : 0.6f, 1.0f};
      table.add(sweep(path, section, scales), frame);
    }
  }
  const float apron = dice.uniform(0.06f, 0.1f);
  for (const float side : {-1.0f, 1.0f}) {
    table.add(box({0.022f, 2 * y, apron}), frame, at(side * x, 0, height - thick - apron));
    table.add(box({2 * x, 0.022f, apron}), frame, at(0, side * y, height - thick - apron));
  }
  return std::move(table).finish();
}

}  // namespace cairn
