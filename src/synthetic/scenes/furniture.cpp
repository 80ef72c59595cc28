// Furniture that no detector of COCO's classes knows.
#include "cairn/synthetic/primitives.h"
#include "cairn/synthetic/scenes/indoors.h"

namespace cairn {

using Eigen::Vector3f;

Shelf make_shelf(Layout& layout, float width, float height, int boards) {
  constexpr float kThick = 0.02f;
  Shelf shelf;
  shelf.width = width;
  shelf.depth = layout.uniform(0.24f, 0.3f);
  const Material wood = layout.chance(0.5f)
                            ? patterned(Pattern::kWood, layout.seed(), 0.15f)
                            : plain(Colour::Constant(layout.uniform(0.5f, 0.75f)), 0.2f);
  const auto side = shelf.mesh.add(wood);
  for (const float end : {-1.f, 1.f}) {
    add_box(shelf.mesh, {0, end * (width - kThick) / 2, height / 2}, {shelf.depth, kThick, height},
            side);
  }
  add_box(shelf.mesh, {-shelf.depth / 2 + 0.004f, 0, height / 2}, {0.008f, width, height}, side);
  const float spacing = (height - 0.06f) / float(boards);
  shelf.gap = spacing - kThick;
  for (int i = 0; i < boards; ++i) {
    const float z = 0.06f + float(i) * spacing;
    add_box(shelf.mesh, {0.004f, 0, z}, {shelf.depth - 0.01f, width - 2 * kThick, kThick}, side,
            {0.3f * float(i), 0.2f * float(i)});
    shelf.boards.push_back(z + kThick / 2);
  }
  add_box(shelf.mesh, {0, 0, height + kThick / 2}, {shelf.depth, width, kThick}, side);
  return shelf;
}

void add_books(Layout& layout, const SE3& T_wo, const Shelf& shelf, float height, int plane) {
  float at = -shelf.width / 2 + 0.03f;
  const float stop = shelf.width / 2 - 0.05f - layout.uniform(0, 0.4f) * shelf.width;
  for (int draw = 0; draw < 200 && at < stop; ++draw) {
    Model book = make_model("book", layout.seed());
    // A book lies with its head at -x and its back at -y; now it stands, its back to the front.
    Eigen::Matrix3d R;  // columns: where the book's x, y, z go
    R << 0, -1, 0, 0, 0, 1, -1, 0, 0;
    Eigen::AlignedBox3d turned;
    for (const auto& vertex : book.mesh.vertices) {
      turned.extend(Eigen::Vector3d(R * vertex.position.cast<double>()));
    }
    const auto thick = float(turned.sizes().y());
    if (at + thick > stop) break;
    const double deepest = double(shelf.depth) - 0.01;
    if (turned.sizes().z() > double(shelf.gap) - 0.005 || turned.sizes().x() > deepest) continue;
    const double room_behind = deepest - turned.sizes().x();
    const double front =
        double(shelf.depth) / 2 - std::min(double(layout.uniform(0.015f, 0.05f)), room_behind);
    const Eigen::Vector3d to(front - turned.max().x(), double(at) - turned.min().y(),
                             double(height) - turned.min().z());
    layout.add_object(std::move(book), T_wo * SE3(R, to), plane);
    at += thick + layout.uniform(0.0005f, 0.004f);
    if (layout.chance(0.08f)) at += layout.uniform(0.03f, 0.15f);
  }
}

}  // namespace cairn
