#include <algorithm>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/loft.h"

namespace cairn {
namespace {

const Eigen::Vector3f kAcross = Eigen::Vector3f::UnitY();

constexpr std::uint32_t kWhite = 0xe8e6e1;

// Varnished wood, or painted where the colour is no wood's.
Material wooden(const Colour& colour, Dice& dice) {
  if (colour.minCoeff() > 0.5f * colour.maxCoeff()) return {.colour = colour, .gloss = 0.2f};
  return {.colour = Colour::Ones(), .texture = wood(1, 1, colour, dice), .gloss = 0.15f};
}

Material woven(const Colour& colour, Dice& dice) {
  return {.colour = Colour::Ones(), .texture = fabric(colour, dice)};
}

void add_feet(Assembly& thing, float x, float y, float height, float thick,
              std::uint32_t material) {
  for (const float sx : {-1.0f, 1.0f})
    for (const float sy : {-1.0f, 1.0f})
      thing.add(sweep({{sx * x, sy * y, 0}, {sx * x, sy * y, height}}, circle(thick / 2, 10),
                      std::vector<float>{0.7f, 1}),
                material);
}

}  // namespace

Model make_couch(Dice& dice) {
  Assembly couch("couch");
  const Colour colour = dice.colour(kFabrics);
  const auto cover = couch.material(woven(colour, dice));
  const auto accent = couch.material(woven(dice.colour(kFabrics), dice));
  const auto legs = couch.material({.colour = dice.colour(kWoods) * 0.5f});
  const float width = dice.uniform(1.5f, 2.3f), deep = dice.uniform(0.82f, 0.96f);
  const float arm = dice.uniform(0.12f, 0.22f), arm_z = dice.uniform(0.54f, 0.64f);
  const float seat_z = dice.uniform(0.4f, 0.46f), back_z = dice.uniform(0.74f, 0.9f);
  const float foot = dice.uniform(0.05f, 0.12f), back = 0.2f, soft = dice.uniform(0.14f, 0.18f);
  const int seats = width < 1.8f ? 2 : 3;
  const BoxOptions round{.radius = 0.04f, .steps = 2};

  add_feet(couch, deep / 2 - 0.07f, width / 2 - 0.07f, foot + 0.02f, 0.05f, legs);
  couch.add(box({deep - 0.02f, width - 0.04f, seat_z - soft - foot + 0.03f}, round), cover,
            at(0, 0, foot));
  couch.add(box({back, width - 2 * arm + 0.04f, back_z - foot - 0.06f}, round), cover,
            at(-deep / 2 + back / 2, 0, foot));
  for (const float side : {-1.0f, 1.0f})
    couch.add(box({deep, arm, arm_z - foot}, {.radius = 0.05f, .steps = 2}), cover,
              at(0, side * (width / 2 - arm / 2), foot));
  const float inner = width - 2 * arm, each = inner / float(seats);
  for (int i = 0; i < seats; ++i) {
    const float y = (float(i) + 0.5f) * each - inner / 2;
    couch.add(cushion({deep - back + 0.02f, each - 0.008f, soft}, 0.045f, 0.015f), cover,
              at(back / 2 + 0.02f, y, seat_z - soft));
    couch.add(cushion({0.17f, each - 0.01f, back_z - seat_z + 0.02f}, 0.06f, 0.02f), cover,
              at(-deep / 2 + back + 0.08f, y, seat_z - 0.01f) * turned(kAcross, -9));
  }
  for (const float side : {-1.0f, 1.0f})  // scatter cushions
    if (dice.chance(0.6f))
      couch.add(cushion({0.13f, 0.42f, 0.42f}, 0.06f, 0.03f), accent,
                at(0.02f, side * (inner / 2 - 0.24f), seat_z) * turned(kAcross, -24) *
                    turned(Eigen::Vector3f::UnitZ(), side * -12));
  return std::move(couch).finish();
}

// The head is at the back; one gets in from the front and the sides.
Model make_bed(Dice& dice) {
  Assembly bed("bed");
  const float width = dice.chance(0.4f) ? dice.uniform(0.9f, 1.2f) : dice.uniform(1.4f, 1.8f);
  const float length = dice.uniform(1.95f, 2.1f), rim = 0.04f;
  const float base_z = dice.uniform(0.22f, 0.34f), mattress = dice.uniform(0.17f, 0.24f);
  const float head_z = dice.uniform(0.8f, 1.15f);
  const bool padded = dice.chance(0.4f);
  const auto frame =
      bed.material(padded ? woven(dice.colour(kFabrics), dice) : wooden(dice.colour(kWoods), dice));
  const auto sheet = bed.material(woven(srgb(0xe6e3dc), dice));
  const auto blanket = bed.material(woven(dice.colour(kFabrics), dice));
  const auto pillow =
      bed.material(woven(dice.chance(0.6f) ? srgb(0xefece6) : dice.colour(kFabrics), dice));

  add_feet(bed, length / 2 - 0.06f, width / 2 - 0.05f, 0.12f, 0.07f, frame);
  bed.add(box({length, width + 2 * rim, base_z - 0.08f}, {.radius = 0.01f}), frame, at(0, 0, 0.1f));
  bed.add(box({0.07f, width + 2 * rim, head_z - 0.05f}, {.radius = 0.015f}), frame,
          at(-length / 2 - 0.03f, 0, 0.05f));
  const float top = base_z + mattress;
  bed.add(cushion({length - 0.03f, width, mattress}, 0.05f, 0.005f), sheet, at(0, 0, base_z));
  // The blanket hangs over three sides.
  const float covered = length * dice.uniform(0.62f, 0.75f), hang = dice.uniform(0.12f, 0.26f);
  bed.add(cushion({covered, width + 0.07f, hang + 0.03f}, 0.045f, 0.01f), blanket,
          at(length / 2 - covered / 2 + 0.02f, 0, top - hang));
  bed.add(cushion({0.3f, width + 0.075f, 0.07f}, 0.03f, 0.01f), sheet,
          at(length / 2 - covered + 0.1f, 0, top - 0.015f));
  const int pillows = width > 1.3f ? 2 : 1;
  for (int i = 0; i < pillows; ++i)
    bed.add(cushion({0.42f, std::min(0.7f, 0.86f * width / float(pillows)), 0.14f}, 0.065f, 0.025f),
            pillow,
            at(-length / 2 + 0.28f, (float(i) - 0.5f * float(pillows - 1)) * width / float(pillows),
               top - 0.01f) *
                turned(kAcross, 8));
  return std::move(bed).finish();
}

Model make_bench(Dice& dice) {
  Assembly bench("bench");
  const float width = dice.uniform(1.3f, 1.9f), seat_z = dice.uniform(0.42f, 0.47f);
  const float seat = dice.uniform(0.38f, 0.46f), top = dice.uniform(0.78f, 0.9f);
  const int slats = 4 + dice.below(3);
  const auto planks = bench.material(wooden(dice.colour(kWoods), dice));
  const auto iron = bench.material({.colour = dice.colour(kMetals) * 0.5f, .gloss = 0.3f});
  const float plank = 0.85f * seat / float(slats);
  const BoxOptions edge{.radius = 0.006f};
  for (const float x : evenly(-seat / 2 + plank / 2, seat / 2 - plank / 2, slats))
    bench.add(box({plank, width, 0.035f}, edge), planks, at(x, 0, seat_z - 0.035f));
  const bool with_back = dice.chance(0.8f);
  const float lean = 0.1f;
  if (with_back)
    for (const float z : evenly(seat_z + 0.14f, top - 0.06f, 3))
      bench.add(box({0.03f, width, 0.09f}, edge), planks,
                at(-seat / 2 - lean * (z - seat_z) / 0.4f, 0, z - 0.045f) * turned(kAcross, -13));
  const Outline bar = rounded_rectangle(0.05f, 0.03f, 0.006f, 1);
  for (const float y : {-0.38f * width, 0.38f * width}) {
    const float z = seat_z - 0.05f;
    bench.add(sweep(round_corners({{seat / 2 + 0.04f, y, 0},
                                   {seat / 2 - 0.04f, y, z},
                                   {-seat / 2 + 0.04f, y, z},
                                   {-seat / 2 - 0.06f, y, 0}},
                                  0.08f),
                    bar),
              iron);
    if (with_back)
      bench.add(sweep({{-seat / 2 + 0.02f, y, z}, {-seat / 2 - 0.02f - lean * 0.95f, y, top}}, bar),
                iron);
  }
  return std::move(bench).finish();
}

// A book case; boxes and binders stand in some of it.
Model make_shelf(Dice& dice) {
  Assembly shelf("shelf");
  const float width = dice.uniform(0.6f, 1.2f), height = dice.uniform(1.3f, 2.1f);
  const float deep = dice.uniform(0.26f, 0.36f), board = dice.uniform(0.016f, 0.026f);
  const int floors = 4 + dice.below(3);
  const Colour colour = dice.chance(0.3f) ? srgb(kWhite) : dice.colour(kWoods);
  const auto boards = shelf.material(wooden(colour, dice));
  const auto back = shelf.material(wooden(colour * 0.7f, dice));
  for (const float side : {-1.0f, 1.0f})
    shelf.add(box({deep, board, height}), boards, at(0, side * (width - board) / 2, 0));
  shelf.add(box({0.006f, width - board, height - 0.05f}), back, at(-deep / 2 + 0.004f, 0, 0.04f));
  const std::vector<float> levels = evenly(0.05f, height - board, floors);
  for (const float z : levels)
    shelf.add(box({deep - 0.004f, width - 2 * board, board}), boards, at(0, 0, z));
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const float room = levels[i + 1] - levels[i] - board;
    float y = -width / 2 + board + dice.uniform(0.02f, 0.1f);
    while (dice.chance(0.8f)) {
      const bool binder = dice.chance(0.6f);
      const float wide = binder ? dice.uniform(0.04f, 0.08f) : dice.uniform(0.18f, 0.3f);
      const float tall = std::min(room - 0.02f, binder ? 0.32f : dice.uniform(0.14f, 0.26f));
      if (y + wide > width / 2 - board - 0.01f) break;
      Canvas front(wide, tall, 1000, dice.colour(kPrints));
      front.rectangle(0.2f * wide, 0.15f * tall, 0.6f * wide, 0.3f * tall, srgb(0xf0ede4));
      front.rectangle(0.28f * wide, 0.22f * tall, 0.44f * wide, 0.03f * tall, srgb(0x303030));
      front.rectangle(0.28f * wide, 0.3f * tall, 0.3f * wide, 0.03f * tall, srgb(0x303030));
      if (binder) front.disc(0.5f * wide, 0.82f * tall, 0.2f * wide, Colour::Constant(0.02f));
      const auto print = shelf.material({.colour = Colour::Ones(), .texture = front.texture()});
      shelf.add(box({deep * 0.82f, wide, tall}, {.radius = 0.003f}), print,
                at(-0.01f, y + wide / 2, levels[i] + board));
      y += wide + (binder ? 0.004f : dice.uniform(0.02f, 0.12f));
    }
  }
  return std::move(shelf).finish();
}

// A chest: doors or drawers side by side and above each other.
Model make_cabinet(Dice& dice) {
  Assembly cabinet("cabinet");
  const float width = dice.uniform(0.6f, 1.6f), deep = dice.uniform(0.4f, 0.6f);
  const float height = dice.uniform(0.7f, 1.1f), foot = dice.uniform(0.04f, 0.14f);
  const Colour colour = dice.chance(0.35f) ? srgb(kWhite) : dice.colour(kWoods);
  const auto body = cabinet.material(wooden(colour, dice));
  const auto fronts =
      cabinet.material(wooden(dice.chance(0.7f) ? colour : dice.colour(kWoods), dice));
  const auto metal = cabinet.material({.colour = dice.colour(kMetals), .gloss = 0.5f});
  add_feet(cabinet, deep / 2 - 0.05f, width / 2 - 0.05f, foot + 0.01f, 0.045f, metal);
  cabinet.add(box({deep, width, height - foot - 0.02f}), body, at(0, 0, foot));
  cabinet.add(box({deep + 0.03f, width + 0.02f, 0.022f}, {.radius = 0.003f}), body,
              at(0.015f, 0, height - 0.022f));
  const int columns = std::max(1, int(width / dice.uniform(0.4f, 0.6f)));
  const int rows = dice.chance(0.5f) ? 1 : 2 + dice.below(3);
  const float wide = (width - 0.02f) / float(columns), tall = (height - foot - 0.06f) / float(rows);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const float y = -width / 2 + 0.01f + (float(i) + 0.5f) * wide;
      const float z = foot + 0.015f + float(j) * tall;
      cabinet.add(box({0.018f, wide - 0.008f, tall - 0.008f}, {.radius = 0.003f}), fronts,
                  at(deep / 2 + 0.009f, y, z + 0.004f));
      const bool door = rows == 1;
      const float knob_y = door ? y + (i % 2 == 0 ? 0.4f : -0.4f) * wide : y;
      const float knob_z = door ? z + 0.6f * tall : z + 0.55f * tall;
      cabinet.add(box({0.02f, door ? 0.012f : 0.12f, door ? 0.12f : 0.012f}, {.radius = 0.004f}),
                  metal, at(deep / 2 + 0.026f, knob_y, knob_z));
    }
  }
  return std::move(cabinet).finish();
}

}  // namespace cairn
