#include <algorithm>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/car_body.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/models/wheel.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/box.h"

namespace cairn {
namespace {

const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

struct Parts {
  std::uint32_t paint, glass, under, trim, chrome, lamp, lens, red, brake, plate;
};

Eigen::Vector3f mirrored(const Eigen::Vector3f& p, float side) {
  return {p.x(), side * p.y(), p.z()};
}

// A thin dark seam that lies on the body.
void add_seam(Assembly& car, const Path& path, float side, std::uint32_t material) {
  Path moved;
  for (const Eigen::Vector3f& p : path) moved.push_back(mirrored(p, side));
  car.add(tube(moved, 0.0045f, 5), material);
}

void add_doors(Assembly& car, const BodyShape& body, const Parts& parts) {
  const float from = body.cowl + 0.1f, to = body.rear_glass_to - 0.1f;
  std::vector<float> seams{from, from + 0.372f * (to - from)};
  if (body.type != BodyType::kVan) seams.push_back(body.rear_axle - body.wheel_radius - 0.1f);
  for (const float side : {-1.0f, 1.0f}) {
    for (const float s : seams) {
      Path seam;
      const float low = body.clearance + 0.1f, high = body.at(s, BodyShape::kBelt).z() - 0.01f;
      for (const float z : evenly(low, high, 6)) seam.push_back(body.side(s, z));
      add_seam(car, seam, side, parts.trim);
    }
    Path sill;
    for (const float s : evenly(seams.front(), seams.back(), 5))
      sill.push_back(body.side(s, body.clearance + 0.1f));
    add_seam(car, sill, side, parts.trim);
    for (std::size_t i = 1; i < seams.size(); ++i) {
      const float s = seams[i] - 0.16f;
      const Eigen::Vector3f p = mirrored(body.side(s, body.deck(s) - 0.14f), side);
      car.add(box({0.17f, 0.035f, 0.028f}, {.radius = 0.01f}), parts.trim, at(p.x(), p.y(), p.z()));
    }
    // The mirror at the foot of the windscreen.
    const float s = body.cowl + 0.22f;
    const Eigen::Vector3f p = mirrored(body.at(s, BodyShape::kBelt), side);
    car.add(box({0.1f, 0.2f, 0.13f}, {.radius = 0.04f, .steps = 2}), parts.paint,
            at(p.x(), p.y() + side * 0.11f, p.z() + 0.02f) * turned(kUp, side * 12));
  }
}

// From the flat face at the nose or the tail around to where make_body() goes on.
void add_lamps(Assembly& car, const BodyShape& body, bool front, float width, std::uint32_t lamp,
               std::uint32_t lens) {
  const float s = front ? 0 : body.length, out = front ? 1.0f : -1.0f;
  const float low = body.at(s, BodyShape::kWaist).z() + 0.008f;
  const float high = body.at(s, front ? BodyShape::kShoulder : BodyShape::kBelt).z() - 0.008f;
  for (const float side : {-1.0f, 1.0f}) {
    // Inside of the body's edge, whose light would be lost under the lamp.
    const float y = side * (body.half_width(s) - width / 2 - 0.025f);
    car.add(box({0.03f, width, high - low}, {.radius = 0.012f, .steps = 2}), lamp,
            at(out * (body.length / 2 - 0.01f), y, low));
    const float radius = 0.36f * std::min(high - low, 0.5f * width);
    for (const float across : {-0.23f, 0.23f})
      car.add(extrude(circle(radius, 16), 0.006f, 0.002f), lens,
              at(out * (body.length / 2 + 0.003f), y + across * width, 0.5f * (low + high)) *
                  turned(Eigen::Vector3f::UnitY(), out * 90));
  }
}

void add_front(Assembly& car, const BodyShape& body, const Parts& parts, Dice& dice) {
  const float nose = body.length / 2, w = body.half_width(0);
  const float lamp = dice.uniform(0.26f, 0.36f);
  add_lamps(car, body, true, lamp, parts.lamp, parts.lens);
  const float top = body.at(0, BodyShape::kShoulder).z();
  const float grille_h = dice.uniform(0.1f, 0.24f), grille_w = 2 * (w - lamp) - 0.06f;
  const float grille_z = top - grille_h;
  car.add(box({0.03f, grille_w, grille_h}, {.radius = 0.012f}), parts.trim,
          at(nose - 0.004f, 0, grille_z));
  const int bars = 2 + dice.below(4);
  const bool chrome = dice.chance(0.6f);
  for (const float z : evenly(grille_z + 0.02f, top - 0.03f, bars))
    car.add(box({0.02f, 0.94f * grille_w, 0.012f}), chrome ? parts.chrome : parts.trim,
            at(nose + 0.006f, 0, z));
  car.add(box({0.012f, 0.1f, 0.1f}, {.radius = 0.005f}), parts.chrome,
          at(nose + 0.014f, 0, grille_z + 0.5f * grille_h - 0.05f));
  const float intake_z = body.clearance + 0.11f;
  car.add(box({0.03f, 1.5f * w, 0.1f}, {.radius = 0.012f}), parts.trim,
          at(nose - 0.006f, 0, intake_z));
  for (const float side : {-1.0f, 1.0f})  // fog lamps
    car.add(box({0.02f, 0.11f, 0.06f}, {.radius = 0.008f}), parts.lamp,
            at(nose + 0.004f, side * 0.62f * w, intake_z + 0.02f));
  car.add(box({0.012f, 0.52f, 0.115f}, {.radius = 0.004f}), parts.plate,
          at(nose + 0.006f, 0, std::min(grille_z - 0.13f, intake_z + 0.05f)));
  for (const float side : {-1.0f, 1.0f}) {  // the gaps beside the bonnet
    Path gap;
    for (const float s : evenly(0.065f * body.length, body.cowl - 0.02f, 24))
      gap.push_back(0.6f * body.at(s, BodyShape::kGlassTop) + 0.4f * body.at(s, BodyShape::kRail));
    add_seam(car, gap, side, parts.trim);
  }
}

void add_rear(Assembly& car, const BodyShape& body, const Parts& parts, Dice& dice) {
  const float tail = -body.length / 2, w = body.half_width(body.length);
  const float lamp =
      body.type == BodyType::kSaloon ? dice.uniform(0.26f, 0.4f) : dice.uniform(0.12f, 0.3f);
  add_lamps(car, body, false, lamp, parts.red, parts.brake);
  const float low = body.at(body.length, BodyShape::kWaist).z();
  const float plate_z = dice.chance(0.5f) ? low + 0.02f : body.clearance + 0.3f;
  car.add(box({0.012f, 0.52f, 0.115f}, {.radius = 0.004f}), parts.plate,
          at(tail - 0.004f, 0, plate_z) * turned(kUp, 180));
  car.add(box({0.03f, 1.6f * w, 0.14f}, {.radius = 0.012f}), parts.trim,
          at(tail, 0, body.clearance + 0.15f));
  const float y = w - lamp - 0.02f;  // the gap around the boot lid
  const Path lid{{tail, -y, body.tail_z - 0.09f},
                 {tail, -y, low - 0.08f},
                 {tail, y, low - 0.08f},
                 {tail, y, body.tail_z - 0.09f}};
  add_seam(car, lid, 1, parts.trim);
  if (body.type != BodyType::kEstate) return;
  for (const float side : {-1.0f, 1.0f}) {  // roof rails
    Path rail;
    const float from = body.roof_from + 0.15f, to = body.roof_to - 0.1f;
    for (const float s : evenly(from, to, 9)) {
      const bool end = s <= from || s >= to;
      rail.push_back(mirrored(body.at(s, BodyShape::kRail), side) + (end ? 0.0f : 0.045f) * kUp);
    }
    car.add(tube(rail, 0.013f, 6), parts.chrome);
  }
}

Print number_plate(Dice& dice) {
  Canvas canvas(0.52f, 0.115f, 1000, srgb(0xf2f2ee));
  canvas.rectangle(0, 0, 0.045f, 0.115f, srgb(0x123a8f));
  std::string number;
  for (int i = 0; i < 7; ++i)
    number += i < 3 ? char('A' + dice.below(26)) : char('0' + dice.below(10));
  canvas.text(number, 0.07f, 0.088f, 0.062f, Colour::Constant(0.01f),
              {.thickness = 0.18f, .max_width = 0.42f});
  return canvas.texture();
}

}  // namespace

Model make_car(Dice& dice) {
  Assembly car("car");
  const int drawn = dice.below(10);
  const BodyType type = drawn < 3   ? BodyType::kSaloon
                        : drawn < 6 ? BodyType::kHatchback
                        : drawn < 9 ? BodyType::kEstate
                                    : BodyType::kVan;
  const BodyShape body = make_body_shape(type, dice);
  Parts parts{};
  parts.paint = car.material(
      {.colour = dice.colour(kCarPaints), .gloss = dice.uniform(0.35f, 0.7f), .shininess = 60});
  parts.glass = car.material({.colour = srgb(0x20262b), .gloss = 0.9f, .shininess = 120});
  parts.under = car.material({.colour = Colour::Constant(0.008f)});
  parts.trim = car.material({.colour = Colour::Constant(0.015f), .gloss = 0.15f});
  parts.chrome = car.material({.colour = srgb(0xc4c7ca), .gloss = 0.8f, .shininess = 80});
  parts.lamp = car.material({.colour = srgb(0x7d878d), .gloss = 0.9f, .shininess = 90});
  parts.lens = car.material({.colour = srgb(0xe6eaec), .gloss = 0.9f, .shininess = 90});
  parts.red = car.material({.colour = srgb(0xa3121a), .gloss = 0.7f, .shininess = 80});
  parts.brake = car.material({.colour = srgb(0xd8202a), .gloss = 0.7f, .shininess = 80});
  parts.plate = car.material({.colour = Colour::Ones(), .texture = number_plate(dice)});
  const bool clad = type == BodyType::kEstate && dice.chance(0.6f);
  car.add(make_body(body), {parts.paint, parts.glass, parts.under, parts.trim,
                            clad ? parts.trim : parts.paint, parts.lamp, parts.red});
  add_doors(car, body, parts);
  add_front(car, body, parts, dice);
  add_rear(car, body, parts, dice);

  WheelLook look{.radius = body.wheel_radius,
                 .width = dice.uniform(0.18f, 0.22f),
                 .spokes = dice.chance(0.5f) ? 5 : 10};
  look.rubber = parts.trim;
  look.rim = car.material({.colour = dice.colour(kMetals), .gloss = 0.6f});
  look.dark = parts.under;
  for (const float axle : {body.front_axle, body.rear_axle})
    for (const float side : {-1.0f, 1.0f})
      add_wheel(car, look,
                {body.length / 2 - axle, side * (body.half_width(axle) - look.width / 2 - 0.015f),
                 body.wheel_radius},
                side);
  return std::move(car).finish();
}

}  // namespace cairn
