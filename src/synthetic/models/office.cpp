#include <algorithm>
#include <cmath>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/keys.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {

// A closed book that lies, its title to be read from the front.
Model make_book(Dice& dice) {
  Assembly book("book");
  const float tall = dice.uniform(0.17f, 0.3f), wide = tall * dice.uniform(0.64f, 0.82f);
  const float thick = dice.uniform(0.012f, 0.05f);
  const bool hard = dice.chance(0.6f);
  const float board = hard ? 0.003f : 0.0012f, overhang = hard ? 0.003f : 0.0f;
  const Colour ground = dice.colour(kPrints);
  const float gloss = dice.uniform(0.05f, 0.3f);
  const auto printed = [&](const Print& print) {
    return book.material({.colour = Colour::Ones(), .texture = print, .gloss = gloss});
  };
  const auto front = printed(book_cover(wide, tall, ground, dice));
  const auto back = printed(book_cover(wide, tall, ground, dice));
  const auto spine = printed(book_spine(tall, thick, ground, dice));
  const auto pages = book.material(
      {.colour = Colour::Ones(), .texture = page_edges(tall, thick - 2 * board, dice)});

  const Eigen::Vector3f cover(tall, wide, board);
  const BoxOptions edge{.radius = 0.3f * board};
  book.add(box(cover, edge), back);
  book.add(box(cover, edge), front, at(0, 0, thick - board));
  book.add(box({tall - 2 * overhang, wide - overhang - board, thick - 2 * board}), pages,
           at(0, 0.5f * (board - overhang), board));
  // The back bone is rounded, on the left of the title.
  const float bend = hard ? 0.15f * thick : 0.0008f;
  Outline round;
  for (const float t : evenly(-1, 1, 7))
    round.emplace_back(-wide / 2 - bend * (1 - t * t), thick / 2 * t);
  std::reverse(round.begin(), round.end());
  round.emplace_back(-wide / 2 + board, -thick / 2);
  round.emplace_back(-wide / 2 + board, thick / 2);
  Ring rings[2];
  for (const Eigen::Vector2f& p : round) {
    rings[0].emplace_back(tall / 2, p.x(), p.y() + thick / 2);
    rings[1].emplace_back(-tall / 2, p.x(), p.y() + thick / 2);
  }
  // The title runs from the head of the spine down: along +x.
  for (Ring& ring : rings) std::reverse(ring.begin(), ring.end());
  Mesh bone = loft(rings, 50);
  for (Mesh::Vertex& v : bone.vertices) v.uv = {v.position.x() + tall / 2, thick - v.position.z()};
  book.add(bone, spine);
  return std::move(book).finish();
}

Model make_keyboard(Dice& dice) {
  Assembly keyboard("keyboard");
  KeyOptions options;
  options.number_pad = dice.chance(0.75f);
  options.pitch = options.number_pad ? dice.uniform(0.0180f, 0.0196f) : 0.019f;
  if (!options.number_pad) options.pitch = dice.uniform(0.0215f, 0.0235f);
  options.height = dice.uniform(0.003f, 0.008f);
  const Colour body = dice.colour(kPlastics);
  options.colour = dice.chance(0.6f) ? body : dice.colour(kPlastics);
  const Keys keys = make_keys(options, dice);
  const float rim = dice.uniform(0.006f, 0.014f), thick = dice.uniform(0.008f, 0.016f);
  const float back = rim + dice.uniform(0, 0.02f), tilt = dice.uniform(0.0f, 0.07f);

  const auto case_material =
      keyboard.material({.colour = body * 0.8f, .gloss = dice.uniform(0.05f, 0.3f)});
  const auto legends =
      keyboard.material({.colour = Colour::Ones(), .texture = keys.legends, .gloss = 0.15f});
  const float deep = keys.depth + rim + back, wide = keys.width + 2 * rim;
  const auto lean = [&](Mesh mesh) {  // higher at the back
    for (Mesh::Vertex& v : mesh.vertices)
      if (v.position.z() > 0.002f) v.position.z() += tilt * (deep / 2 - v.position.x());
    shade(mesh, 35);
    return mesh;
  };
  keyboard.add(lean(box({deep, wide, thick}, {.radius = 0.003f})), case_material);
  Mesh placed;
  placed.append(keys.mesh, at(back - deep / 2, -keys.width / 2, thick - 0.0005f));
  keyboard.add(lean(placed), legends);
  return std::move(keyboard).finish();
}

// Its buttons look away from the front, where the hand comes from.
Model make_mouse(Dice& dice) {
  Assembly mouse("mouse");
  const float length = dice.uniform(0.095f, 0.125f), width = length * dice.uniform(0.52f, 0.64f);
  const float height = dice.uniform(0.028f, 0.042f), hump = dice.uniform(0.0f, 0.35f);
  const float waist = dice.uniform(0.02f, 0.14f), nose = dice.uniform(0.35f, 0.6f);
  const Colour colour = dice.colour(kPlastics);
  const auto shaped = [&](const Eigen::Vector3f& p) {
    const float along = 2 * p.x() / length;  // -1 at the buttons, 1 at the palm
    const float across = 2 * p.y() / width;
    const float pinch = 1 - waist * (1 - along * along);
    const float top = (1 - nose * std::max(0.0f, -along - 0.1f) * 0.9f) *
                      (1 - 0.45f * std::max(0.0f, along - hump)) * (1 - 0.22f * across * across);
    return Eigen::Vector3f(p.x() * (1 - 0.12f * across * across), p.y() * pinch, p.z() * top);
  };
  Mesh shell = box({length, width, height}, {.radius = 0.4f * height, .steps = 3, .cell = 0.007f});
  deform(shell, shaped, 70);
  mouse.add(shell, mouse.material({.colour = colour, .gloss = dice.uniform(0.1f, 0.5f)}));

  const auto dark = mouse.material(
      {.colour = Colour::Constant(colour.mean() < 0.1f ? 0.12f : 0.02f), .gloss = 0.2f});
  const float wheel_x = -0.28f * length, radius = 0.2f * height;
  const float wheel_z = shaped({wheel_x, 0, height}).z() - 0.55f * radius;
  Mesh wheel = extrude(circle(radius, 16), 0.007f, 0.001f);
  mouse.add(wheel, dark, at(wheel_x, 0.0035f, wheel_z) * turned(Eigen::Vector3f::UnitX(), 90));
  // The gap between the buttons, from the wheel to the nose: a strip that lies on the shell.
  Path gap;
  for (const float x : evenly(-0.47f * length, 0.0f, 10))
    gap.push_back(shaped({x, 0, height}) - Eigen::Vector3f(0, 0, 0.0004f));
  mouse.add(tube(gap, 0.0008f, 6), dark);
  return std::move(mouse).finish();
}

}  // namespace cairn
