// A living room; the camera walks around the table in its middle, looking across it, and comes back
// to where it began.
#include "cairn/synthetic/scenes/hand_motion.h"
#include "cairn/synthetic/scenes/indoors.h"
#include "cairn/synthetic/scenes/makers.h"

namespace cairn {
namespace {

using Eigen::Vector3f;

constexpr double kLap = 24;  // seconds

// Furniture side by side along a wall, from left to right, as far as it fits.
void fill_wall(Layout& layout, const Room& room, int wall, float from, float to,
               std::initializer_list<const char*> classes) {
  float at = from;
  for (const std::string name : classes) {
    Model model = make_model(name, layout.seed());
    const Eigen::AlignedBox3f box = extent(model);
    const float wide = box.sizes().y();
    if (box.sizes().x() > 1.1f || at + wide > to) continue;
    const SE3 T_wo = room.at_wall(wall, at + wide / 2, model);
    if (!layout.is_free(model, T_wo)) continue;
    const int thing = layout.add_object(std::move(model), T_wo, room.floor_plane());
    at += wide + layout.uniform(0.08f, 0.3f);
    if (name != "cabinet") continue;
    const Eigen::Vector3d front = layout.thing(thing).T_wo.rotation() * Eigen::Vector3d::UnitX();
    lay_things(layout, layout.add_top(thing, name), {"tv", "vase", "book", "clock", "bowl"},
               float(std::atan2(front.y(), front.x())));
  }
}

// A laid table with chairs around it.
void set_middle(Layout& layout, const Room& room) {
  // In line with the walls, because lay_things takes the table's extent along x and y.
  const float yaw = 0.5f * float(M_PI) * float(layout.below(2));
  Model table = make_long_table(layout);
  const Vector3f half = 0.5f * extent(table).sizes();
  const int thing =
      layout.add_object(std::move(table), standing({0, 0, 0}, yaw), room.floor_plane());
  lay_things(layout, layout.add_top(thing, "table"),
             {"laptop", "potted plant", "bowl", "vase", "bottle", "cup", "book", "book", "cup",
              "bottle", "banana", "orange", "apple"});
  for (const float side : {-1.f, 1.f}) {
    for (int axis = 0; axis < 2; ++axis) {
      Model chair = make_low_chair(layout);
      Vector3f at = Vector3f::Zero();
      const float askew = layout.uniform(-0.3f, 0.3f);
      const Vector3f front = extent(chair, standing(Vector3f::Zero(), askew)).max();
      at[axis] = side * (half[axis] + front.x() + layout.uniform(0.02f, 0.15f));
      at[1 - axis] = layout.uniform(-0.1f, 0.1f);
      const Eigen::AngleAxisf turn(yaw, Vector3f::UnitZ());
      const float facing = std::atan2(-at.y(), -at.x()) + yaw + askew;
      layout.add_object(std::move(chair), standing(turn * at, facing), room.floor_plane());
    }
  }
}

SE3 walk(double t, const HandMotion& hand, const Eigen::Vector2d& radii) {
  const double lap = t / kLap, turn = 2 * M_PI * lap;
  // Waves that fit the lap, so that it closes.
  const double in = 1 + 0.08 * std::sin(3 * turn) + 0.05 * std::sin(5 * turn + 1);
  const Eigen::Vector3d at(in * radii.x() * std::cos(turn), in * radii.y() * std::sin(turn),
                           1.35 + 0.08 * std::sin(2 * turn) + 0.03 * std::sin(7 * turn));
  const double across = turn + M_PI + 0.3 + 0.15 * std::sin(4 * turn);
  const double down = 0.22 + 0.08 * std::sin(3 * turn + 2);
  const Eigen::Vector3d look(std::cos(across) * std::cos(down), std::sin(across) * std::cos(down),
                             -std::sin(down));
  const double swing = std::sin(M_PI * lap);
  return looking_at(at, at + look, 0.03 * std::sin(4 * turn)) * hand.tremble(t, swing * swing);
}

}  // namespace

Scene make_room(std::uint64_t seed) {
  Layout layout("room", seed);
  const Vector3f size(layout.uniform(6.6f, 7.2f), layout.uniform(5.8f, 6.4f), 2.6f);
  Room room(layout, size, layout.one_of({Pattern::kParquet, Pattern::kTiles, Pattern::kCarpet}),
            layout.one_of({Pattern::kPlaster, Pattern::kWallpaper}));
  const float x = size.x() / 2 - 0.5f, y = size.y() / 2 - 0.5f;
  fill_wall(layout, room, 0, -y, y, {"shelf", "cabinet", "potted plant", "shelf", "chair"});
  fill_wall(layout, room, 1, -x, x, {"floor lamp", "couch", "suitcase", "cabinet", "potted plant"});
  fill_wall(layout, room, 2, -y, y, {"refrigerator", "cabinet", "chair", "potted plant"});
  fill_wall(layout, room, 3, -x, -0.6f, {"shelf", "backpack", "cabinet"});
  room.add_door(3, 0.4f, Colour(0.5f, 0.42f, 0.33f));
  fill_wall(layout, room, 3, 1.2f, x, {"cabinet", "bench"});
  set_middle(layout, room);
  for (int wall = 0; wall < 4; ++wall) {
    const float reach = room.wall_width(wall) / 2 - 0.7f;
    if (wall != 3) room.add_poster(wall, layout.uniform(0.4f, 1) * reach, 1.75f, 0.9f);
    room.add_poster(wall, -layout.uniform(0.5f, 1) * reach, 1.75f, layout.uniform(0.7f, 1));
  }
  room.add_window(1, 0.1f, 1.9f, 1.5f, 0.9f, layout.uniform(0.8f, 1.2f) * Colour(6, 6.6f, 7.4f));
  room.add_window(2, 0.4f, 1.9f, 1.2f, 0.9f, layout.uniform(0.8f, 1.2f) * Colour(5, 5.6f, 6.4f));
  room.add_ceiling_lamp({0, 0}, {1.2f, 1.2f}, layout.uniform(0.8f, 1.2f) * Colour(5, 4.5f, 3.8f));
  Scene& scene = layout.scene();
  scene.ambient = Colour(0.04f, 0.039f, 0.037f);
  const HandMotion hand(seed + 200);
  const Eigen::Vector2d radii(size.x() / 2 - 1.5, size.y() / 2 - 1.4);
  scene.path = [hand, radii](double t) { return walk(t, hand, radii); };
  scene.duration = kLap;
  return std::move(layout).finish();
}

}  // namespace cairn
