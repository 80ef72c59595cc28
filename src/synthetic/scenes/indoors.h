#pragma once

#include "cairn/synthetic/scenes/layout.h"
#include "cairn/synthetic/texture.h"

namespace cairn {

/// A room around the origin with four walls. A wall's frame: x to the right as seen from inside, y
/// up, z into the room; origin at the middle of its lower edge.
class Room {
 public:
  /// Wall 0 is at +x, 1 at +y, 2 at -x, 3 at -y.
  Room(Layout& layout, const Eigen::Vector3f& size, Pattern floor, Pattern wall);

  const Eigen::Vector3f& size() const { return size_; }
  int floor_plane() const { return floor_; }
  SE3 wall(int index) const;
  /// Where a model stands with its back at a wall, `x` along it.
  SE3 at_wall(int wall, float x, const Model& model) const;
  float wall_width(int index) const { return index % 2 == 0 ? size_.y() : size_.x(); }

  /// A window that daylight comes through. `x`, `y`: its middle, in the wall's frame.
  void add_window(int wall, float x, float y, float width, float height, const Colour& daylight);
  void add_poster(int wall, float x, float y, float scale);
  void add_door(int wall, float x, const Colour& colour);
  /// A panel on the ceiling.
  void add_ceiling_lamp(const Eigen::Vector2f& at, const Eigen::Vector2f& size,
                        const Colour& radiance);

 private:
  Layout& layout_;
  Eigen::Vector3f size_;
  int floor_ = 0;
};

/// A table whose top is a rectangle: on a round one things would be laid beside it.
Model make_long_table(Layout& layout);
/// A chair that a camera in the hand looks over.
Model make_low_chair(Layout& layout);
/// Lays things of these classes onto a rectangular plane, as many as find room; their fronts
/// towards `yaw` (radians from +x), or any way.
void lay_things(Layout& layout, int plane, std::initializer_list<const char*> classes,
                std::optional<float> yaw = {});

Material patterned(Pattern pattern, std::uint64_t seed, float gloss = 0, float shininess = 30);
Material plain(const Colour& colour, float gloss = 0, float shininess = 30);

/// A door leaf with frame and handle, 0.9 x 2.05 m; in a wall's frame, its middle at x = 0.
Mesh door_mesh(const Colour& colour);

/// A shelf of boards.
struct Shelf {
  Mesh mesh;
  std::vector<float> boards;  ///< heights of the boards' upper sides
  float width = 0, depth = 0;
  float gap = 0;  ///< between a board and the next
};
/// Model frame: front towards +x, footprint's middle at the origin.
Shelf make_shelf(Layout& layout, float width, float height, int boards);
/// Fills a board with books that stand side by side, spines to the front.
void add_books(Layout& layout, const SE3& T_wo, const Shelf& shelf, float height, int plane);

}  // namespace cairn
