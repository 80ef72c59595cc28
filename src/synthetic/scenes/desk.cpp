// A table in the corner of a room, with what lies on tables, filmed by hand.
#include <limits>

#include "cairn/synthetic/primitives.h"
#include "cairn/synthetic/scenes/hand_motion.h"
#include "cairn/synthetic/scenes/indoors.h"
#include "cairn/synthetic/scenes/makers.h"

namespace cairn {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kHalfTurn = float(M_PI);
constexpr float kToViewer = kHalfTurn / 2;  // a front (+x) turned towards +y

struct Table {
  Vector3f centre;  // of the top
  Vector2f half;    // along x and y
  int plane = 0;
};

// Long side along x, its back near the wall at -y.
Table add_table(Layout& layout, const Room& room) {
  Model table = make_long_table(layout);
  const Eigen::AlignedBox3f box = extent(table);
  const float yaw = box.sizes().x() > box.sizes().y() ? 0 : kToViewer;
  const float depth = std::min(box.sizes().x(), box.sizes().y());
  const Vector3f at(layout.uniform(-0.4f, 0.2f), -room.size().y() / 2 + depth / 2 + 0.06f, 0);
  const int thing = layout.add_object(std::move(table), standing(at, yaw), room.floor_plane());
  Table result;
  result.plane = layout.add_top(thing, "table");
  Eigen::AlignedBox3d top;
  for (const auto& corner : layout.plane(result.plane).outline) top.extend(corner);
  result.centre = top.center().cast<float>();
  result.half = (0.5 * top.sizes().head<2>()).cast<float>();
  return result;
}

void put(Layout& layout, Tray& tray, const Table& table, const std::string& class_name,
         const Vector2f& place, float yaw) {
  Model model = make_model(class_name, layout.seed());
  const Vector3f at = table.centre + Vector3f(place.x(), place.y(), 0);
  const SE3 T_wo = standing(at, yaw);
  if (tray.claim(model, T_wo)) layout.add_object(std::move(model), T_wo, table.plane);
}

// A few books on each other, each turned a little.
void pile_books(Layout& layout, Tray& tray, const Table& table) {
  float height = 0;
  std::optional<SE3> base;
  for (int i = layout.below(3) + 2; i > 0; --i) {
    Model book = make_model("book", layout.seed());
    if (!base) base = tray.find(book, layout, 0.8f, 2.4f);
    if (!base) return;
    const float thick = extent(book).max().z();
    const SE3 T_bo =
        standing({layout.uniform(-0.01f, 0.01f), layout.uniform(-0.01f, 0.01f), height},
                 layout.uniform(-0.15f, 0.15f));
    // Only the lowest one stands on a plane.
    layout.add_object(std::move(book), *base * T_bo,
                      height > 0 ? std::optional<int>() : std::optional(table.plane));
    height += thick;
  }
}

void set_table(Layout& layout, const Table& table) {
  Tray tray(table.centre - Vector3f(table.half.x(), table.half.y(), 0), {2 * table.half.x(), 0, 0},
            {0, 2 * table.half.y(), 0});
  const float screen_x = layout.uniform(-0.15f, 0.15f);
  const auto turn = [&] { return kToViewer + layout.uniform(-0.15f, 0.15f); };
  put(layout, tray, table, "tv", {screen_x, -0.5f * table.half.y()}, turn());
  put(layout, tray, table, "keyboard", {screen_x, 0.35f * table.half.y()}, turn());
  put(layout, tray, table, "mouse", {screen_x + 0.34f, 0.35f * table.half.y()}, turn());
  const float side = layout.chance(0.5f) ? 1.f : -1.f;
  put(layout, tray, table, "laptop", {side * 0.66f * table.half.x(), -0.05f},
      kToViewer + side * layout.uniform(0.2f, 0.5f));
  pile_books(layout, tray, table);
  for (const auto& [name, count] :
       {std::pair("cup", 3), std::pair("bottle", 2), std::pair("book", 2), std::pair("bowl", 1),
        std::pair("cell phone", 1), std::pair("remote", 1), std::pair("apple", 1),
        std::pair("potted plant", 1)}) {
    for (int i = 0; i < count; ++i) {
      Model model = make_model(name, layout.seed());
      const bool flat = std::string(name) == "book" || std::string(name) == "cell phone";
      const auto T_wo = tray.find(model, layout, flat ? 0.9f : 0, flat ? 2.2f : 2 * kHalfTurn);
      if (T_wo) layout.add_object(std::move(model), *T_wo, table.plane);
    }
  }
}

void furnish(Layout& layout, Room& room, const Table& table) {
  const float left = -room.size().x() / 2, back = -room.size().y() / 2;
  // A shelf at the wall on the left (-x).
  Shelf shelf = make_shelf(layout, layout.uniform(0.9f, 1.2f), layout.uniform(1.5f, 1.9f), 5);
  const SE3 T_ws = standing({left + shelf.depth / 2 + 0.02f, back + 1.5f, 0}, 0);
  for (const float board : shelf.boards) {
    const Vector3f corner(-shelf.depth / 2 + 0.01f, -shelf.width / 2 + 0.02f, board);
    const Vector3f far(shelf.depth / 2, shelf.width / 2 - 0.02f, board);
    std::vector<Vector3f> outline;
    for (const Vector3f& p : {corner, Vector3f(far.x(), corner.y(), board), far,
                              Vector3f(corner.x(), far.y(), board)}) {
      outline.push_back((T_ws * p.cast<double>()).cast<float>());
    }
    add_books(layout, T_ws, shelf, board, layout.add_plane("shelf", outline));
  }
  layout.add_surface("shelf", std::move(shelf.mesh), T_ws, room.floor_plane());
  Model model = make_model("cabinet", layout.seed());
  const SE3 T_wo = room.at_wall(0, layout.uniform(0.5f, 0.9f), model);
  const int cabinet = layout.add_object(std::move(model), T_wo, room.floor_plane());
  lay_things(layout, layout.add_top(cabinet, "cabinet"), {"potted plant", "vase", "bowl", "clock"});
  Model chair = make_low_chair(layout);
  const float aside = layout.uniform(-0.35f, 0.35f);
  const float facing = -kToViewer + layout.uniform(-0.5f, 0.5f);
  // What is as high as the table top stays in front of it.
  const SE3 turned = standing(Vector3f::Zero(), facing);
  float nearest = std::numeric_limits<float>::infinity();
  for (const Mesh::Vertex& vertex : chair.mesh.vertices) {
    if (vertex.position.z() < table.centre.z() - 0.12f) continue;
    nearest = std::min(nearest, float((turned * vertex.position.cast<double>()).y()));
  }
  layout.add_object(
      std::move(chair),
      standing({table.centre.x() + aside,
                table.centre.y() + table.half.y() + layout.uniform(0.03f, 0.1f) - nearest, 0},
               facing),
      room.floor_plane());
}

}  // namespace

Scene make_desk(std::uint64_t seed) {
  Layout layout("desk", seed);
  const Vector3f size(layout.uniform(3.8f, 4.4f), layout.uniform(3.6f, 4.2f), 2.5f);
  Room room(layout, size, layout.one_of({Pattern::kParquet, Pattern::kTiles, Pattern::kCarpet}),
            layout.one_of({Pattern::kPlaster, Pattern::kWallpaper}));
  const Table table = add_table(layout, room);
  set_table(layout, table);
  furnish(layout, room, table);
  for (int i = 0; i < 3; ++i) {
    room.add_poster(3, -table.centre.x() + 0.85f * float(i - 1) + layout.uniform(-0.1f, 0.1f),
                    layout.uniform(1.55f, 1.75f), layout.uniform(0.7f, 1.05f));
  }
  room.add_poster(0, layout.uniform(-1.2f, -0.6f), 1.6f, layout.uniform(0.8f, 1.1f));
  const float noon = layout.uniform(0.8f, 1.2f);
  // Between the shelf and whoever films.
  room.add_window(2, 1.0f, 1.5f, 1.0f, 1.4f, noon * Colour(4.6f, 5.2f, 6.0f));
  room.add_ceiling_lamp({0.2f, 0}, {1.2f, 0.3f},
                        layout.uniform(0.7f, 1.2f) * Colour(9.0f, 8.0f, 6.6f));
  room.add_door(1, layout.uniform(-0.8f, 0.8f), Colour(0.5f, 0.42f, 0.33f));
  Scene& scene = layout.scene();
  scene.ambient = Colour(0.035f, 0.034f, 0.032f);
  const HandMotion hand(seed + 100);
  const Eigen::Vector3d middle = table.centre.cast<double>();
  scene.path = [hand, middle](double t) {
    const double azimuth = M_PI / 2 + 0.55 * hand.wander(t, 0, 15) + 0.06 * hand.wander(t, 1, 4);
    const double elevation = 0.55 + 0.12 * hand.wander(t, 2, 9);
    const double radius = 1.25 + 0.18 * hand.wander(t, 3, 11);
    const Eigen::Vector3d target =
        middle + Eigen::Vector3d(0.34 * hand.wander(t, 4, 7), 0.16 * hand.wander(t, 5, 6),
                                 0.10 + 0.10 * hand.wander(t, 6, 5));
    const Eigen::Vector3d from(std::cos(azimuth) * std::cos(elevation),
                               std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
    return looking_at(middle + radius * from, target, 0.05 * hand.wander(t, 7, 6)) *
           hand.tremble(t, 1.8);
  };
  scene.duration = 10;
  return std::move(layout).finish();
}

}  // namespace cairn
