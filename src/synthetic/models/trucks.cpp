#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/models/wheel.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

// Vehicles that are made of boxes; the front looks to +x.

namespace cairn {
namespace {

struct Paints {
  std::uint32_t paint, glass, dark, lamp, red;
};

Paints make_paints(Assembly& vehicle, const Colour& colour) {
  return {.paint = vehicle.material({.colour = colour, .gloss = 0.45f, .shininess = 50}),
          .glass = vehicle.material({.colour = srgb(0x20262b), .gloss = 0.9f, .shininess = 120}),
          .dark = vehicle.material({.colour = Colour::Constant(0.012f), .gloss = 0.1f}),
          .lamp = vehicle.material({.colour = srgb(0xd5dade), .gloss = 0.9f, .shininess = 90}),
          .red = vehicle.material({.colour = srgb(0xa3121a), .gloss = 0.6f})};
}

// A prism across the vehicle over a side view (x, z), counter-clockwise seen from -y.
Mesh across(const Outline& side_view, float width, float bevel) {
  Mesh mesh = extrude(side_view, width, bevel, 35);
  Mesh upright;
  upright.append(mesh, at(0, width / 2, 0) * turned(Eigen::Vector3f::UnitX(), 90));
  return upright;
}

Outline circle_at(float x, float z, float radius) {
  Outline outline = circle(radius, 24);
  for (Eigen::Vector2f& p : outline) p += Eigen::Vector2f(x, z);
  return outline;
}

void add_axles(Assembly& vehicle, std::span<const float> axles, float radius, float track,
               const Paints& paints, Dice& dice) {
  WheelLook look{.radius = radius, .width = 0.28f, .spokes = 8};
  look.rubber = look.dark = paints.dark;
  look.rim = vehicle.material({.colour = dice.colour(kMetals), .gloss = 0.4f});
  for (const float x : axles)
    for (const float side : {-1.0f, 1.0f})
      add_wheel(vehicle, look, {x, side * (track / 2 - 0.14f), radius}, side);
}

}  // namespace

// A cab before a box, a flat bed or a tipper.
Model make_truck(Dice& dice) {
  Assembly truck("truck");
  const float length = dice.uniform(5.6f, 8.0f), width = dice.uniform(2.0f, 2.4f);
  const float cab_h = dice.uniform(2.3f, 2.7f), cab_l = dice.uniform(1.6f, 2.0f);
  const float box_h = dice.uniform(1.9f, 2.4f), floor_z = dice.uniform(0.85f, 1.0f);
  const float wheel = dice.uniform(0.38f, 0.46f), nose = dice.uniform(0.0f, 0.3f);
  const Paints paints = make_paints(truck, dice.colour(kCarPaints));
  const float front = length / 2, back = -length / 2, low = 0.45f;

  const Outline cab{{front - cab_l, low},
                    {front, low},
                    {front, 1.25f},
                    {front - nose * 0.5f, 1.35f},
                    {front - 0.22f - nose, cab_h - 0.12f},
                    {front - 0.4f - nose, cab_h},
                    {front - cab_l, cab_h}};
  truck.add(across(cab, width, 0.06f), paints.paint);
  // Glass lies on the cab: the windscreen along its slope, the doors' windows on the sides.
  const Eigen::Vector2f foot(front - nose * 0.5f, 1.4f), top(front - 0.2f - nose, cab_h - 0.2f);
  const Eigen::Vector2f slope = (top - foot).normalized(), out(slope.y(), -slope.x());
  const Outline screen{foot - 0.03f * out, foot + 0.012f * out, top + 0.012f * out,
                       top - 0.03f * out};
  truck.add(across(screen, 0.86f * width, 0.005f), paints.glass);
  const Outline window{{front - cab_l + 0.35f, 1.45f},
                       {front - 0.22f - nose * 0.5f, 1.45f},
                       {front - 0.4f - nose, cab_h - 0.3f},
                       {front - cab_l + 0.35f, cab_h - 0.3f}};
  truck.add(across(window, width + 0.014f, 0.004f), paints.glass);
  for (const float side : {-1.0f, 1.0f}) {
    for (const float x : {front - 0.25f, front - cab_l + 0.3f})  // the door's gaps
      truck.add(box({0.012f, 0.01f, 0.95f}), paints.dark, at(x, side * width / 2, low + 0.1f));
    truck.add(box({0.14f, 0.035f, 0.04f}), paints.dark,
              at(front - cab_l + 0.45f, side * (width / 2 + 0.005f), 1.25f));
    truck.add(box({0.1f, 0.16f, 0.38f}, {.radius = 0.03f}), paints.dark,
              at(front - 0.12f - nose, side * (width / 2 + 0.12f), 1.6f));
    truck.add(box({0.06f, 0.34f, 0.2f}, {.radius = 0.025f}), paints.lamp,
              at(front, side * 0.36f * width, 0.68f));
    truck.add(box({0.05f, 0.3f, 0.16f}, {.radius = 0.02f}), paints.red,
              at(back + 0.02f, side * 0.36f * width, 0.62f));
  }
  truck.add(box({0.05f, 0.56f * width, 0.38f}, {.radius = 0.02f}), paints.dark,
            at(front, 0, 0.78f));
  truck.add(box({0.16f, width, 0.2f}, {.radius = 0.04f}), paints.dark, at(front - 0.02f, 0, 0.4f));
  truck.add(box({length - 0.6f, 0.8f, 0.25f}), paints.dark, at(-0.1f, 0, floor_z - 0.27f));

  const float bed_l = length - cab_l - 0.12f, bed_x = back + bed_l / 2;
  const Colour cargo = dice.chance(0.5f) ? srgb(0xf0f0ee) : dice.colour(kCarPaints);
  if (dice.chance(0.7f)) {
    Canvas side(bed_l, box_h, 120, cargo);
    const std::string name = dice.word(4, 8);
    const float tall = 0.25f * box_h;
    side.rectangle(0, 0.72f * box_h, bed_l, 0.08f * box_h, dice.colour(kPrints));
    side.text(name, 0.1f * bed_l, 0.55f * box_h, tall, dice.colour(kPrints),
              {.thickness = 0.2f, .max_width = 0.8f * bed_l});
    const auto print =
        truck.material({.colour = Colour::Ones(), .texture = side.texture(), .gloss = 0.15f});
    truck.add(box({bed_l, width + 0.1f, box_h}, {.radius = 0.02f}), print, at(bed_x, 0, floor_z));
    truck.add(box({0.01f, 0.012f, box_h - 0.2f}), paints.dark, at(back, 0, floor_z + 0.1f));
  } else {
    const auto bed = truck.material({.colour = cargo, .gloss = 0.2f});
    const float wall = dice.uniform(0.4f, 0.8f);
    truck.add(box({bed_l, width + 0.06f, 0.12f}), bed, at(bed_x, 0, floor_z));
    for (const float s : {-1.0f, 1.0f}) {
      truck.add(box({bed_l, 0.05f, wall}), bed, at(bed_x, s * width / 2, floor_z + 0.1f));
      truck.add(box({0.05f, width, wall}), bed,
                at(bed_x + s * (bed_l / 2 - 0.025f), 0, floor_z + 0.1f));
    }
  }
  const float axles[] = {front - 0.75f, back + 1.3f};
  add_axles(truck, axles, wheel, width, paints, dice);
  return std::move(truck).finish();
}

Model make_bus(Dice& dice) {
  Assembly bus("bus");
  const float length = dice.uniform(9.5f, 12.2f), width = dice.uniform(2.4f, 2.55f);
  const float height = dice.uniform(2.9f, 3.2f), low = 0.33f, wheel = dice.uniform(0.45f, 0.5f);
  const Paints paints = make_paints(bus, dice.colour(kCarPaints));
  const auto stripe = bus.material({.colour = dice.colour(kPrints), .gloss = 0.4f});
  const float front = length / 2, lean = dice.uniform(0.05f, 0.3f);
  const Outline side_view{{-front, low},
                          {front, low},
                          {front, 1.15f},
                          {front - lean, height - 0.12f},
                          {front - lean - 0.2f, height},
                          {-front + 0.1f, height},
                          {-front, height - 0.15f}};
  bus.add(across(side_view, width, 0.08f), paints.paint);
  bus.add(box({length - 0.1f, width + 0.01f, 0.2f}, {.radius = 0.004f}), stripe, at(0, 0, 0.95f));
  const Eigen::Vector2f foot(front, 1.2f), top(front - lean * 0.86f, height - 0.42f);
  const Eigen::Vector2f slope = (top - foot).normalized(), out(slope.y(), -slope.x());
  bus.add(across({foot - 0.03f * out, foot + 0.012f * out, top + 0.012f * out, top - 0.03f * out},
                 0.9f * width, 0.005f),
          paints.glass);
  // Where the bus goes to.
  Canvas sign(1.4f, 0.26f, 400, Colour::Constant(0.006f));
  sign.text(std::to_string(1 + dice.below(99)) + " " + dice.word(5, 8), 0.06f, 0.19f, 0.14f,
            srgb(0xffb020), {.thickness = 0.16f, .max_width = 1.28f});
  const auto display = bus.material({.colour = Colour::Constant(0.05f),
                                     .texture = sign.texture(),
                                     .emission = Colour::Constant(1)});
  bus.add(box({0.03f, 1.4f, 0.26f}), display, at(front - lean * 0.9f, 0, height - 0.42f));
  const int windows = int((length - 2.2f) / dice.uniform(1.2f, 1.6f));
  const float pitch = (length - 1.9f) / float(windows), glass_z = dice.uniform(1.2f, 1.35f);
  for (int i = 0; i < windows; ++i)
    bus.add(box({pitch - 0.08f, width + 0.016f, height - 0.4f - glass_z}, {.radius = 0.006f}),
            paints.glass, at(-front + 0.5f + (float(i) + 0.5f) * pitch, 0, glass_z));
  for (const float x : {front - 0.75f, -0.06f * length})  // doors, on the right side
    bus.add(box({1.1f, 0.02f, height - 0.75f}, {.radius = 0.008f}), paints.glass,
            at(x, -width / 2 - 0.006f, low + 0.1f));
  for (const float side : {-1.0f, 1.0f}) {
    bus.add(box({0.06f, 0.36f, 0.18f}, {.radius = 0.025f}), paints.lamp,
            at(front - 0.005f, side * 0.34f * width, 0.62f));
    bus.add(box({0.06f, 0.16f, 0.5f}, {.radius = 0.025f}), paints.red,
            at(-front + 0.005f, side * 0.42f * width, 0.8f));
    bus.add(box({0.12f, 0.2f, 0.42f}, {.radius = 0.04f}), paints.dark,
            at(front + 0.12f, side * (width / 2 + 0.05f), 1.9f));
  }
  bus.add(box({0.02f, 0.84f * width, 0.9f}, {.radius = 0.006f}), paints.glass, at(-front, 0, 1.5f));
  bus.add(box({0.05f, 0.9f * width, 0.22f}, {.radius = 0.02f}), paints.dark,
          at(front - 0.005f, 0, low + 0.03f));
  const float axles[] = {front - 2.5f, -front + 3.0f};
  for (const float x : axles)
    bus.add(across(circle_at(x, wheel, wheel + 0.1f), width + 0.006f, 0.002f), paints.dark);
  add_axles(bus, axles, wheel, width + 0.03f, paints, dice);
  return std::move(bus).finish();
}

}  // namespace cairn
