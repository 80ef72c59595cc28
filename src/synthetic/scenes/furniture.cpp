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
    add_box(shelf.mesh, {0, end * (width - kThick) / 2, height / 2},
            {shelf.depth, kThick, height}, side);
  }
  add_box(shelf.mesh, {-shelf.depth / 2 + 0.004f, 0, height / 2}, {0.008f, width, height}, side);
  for (int i = 0; i < boards; ++i) {
    const float z = 0.06f + float(i) * (height - 0.06f) / float(boards);
    add_box(shelf.mesh, {0.004f, 0, z}, {shelf.depth - 0.01f, width - 2 * kThick, kThick}, side,
            {0.3f * float(i), 0.2f * float(i)});
    shelf.boards.push_back(z + kThick / 2);
  }
  add_box(shelf.mesh, {0, 0, height + kThick / 2}, {shelf.depth, width, kThick}, side);
  return shelf;
}

Mesh make_cabinet(Layout& layout, const Vector3f& size) {
  Mesh mesh;
  const auto body = mesh.add(layout.chance(0.6f)
                                 ? patterned(Pattern::kWood, layout.seed(), 0.2f)
                                 : plain(Colour::Constant(layout.uniform(0.4f, 0.75f)), 0.25f));
  const auto metal = mesh.add(plain(Colour::Constant(0.4f), 0.8f, 100));
  add_box(mesh, {-0.01f, 0, size.z() / 2}, {size.x() - 0.02f, size.y(), size.z()}, body);
  const int rows = 1 + int(size.z() / 0.28f), columns = 1 + int(size.y() / 0.7f);
  const float w = size.y() / float(columns), h = (size.z() - 0.06f) / float(rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float y = -size.y() / 2 + (float(column) + 0.5f) * w;
      const float z = 0.05f + (float(row) + 0.5f) * h;
      add_box(mesh, {size.x() / 2 - 0.01f, y, z}, {0.02f, w - 0.012f, h - 0.012f}, body,
              {0.7f * float(row), 0.4f * float(column)});
      add_box(mesh, {size.x() / 2 + 0.012f, y, z + 0.25f * h}, {0.016f, 0.12f, 0.012f}, metal);
    }
  }
  return mesh;
}

void add_books(Layout& layout, const SE3& T_wo, const Shelf& shelf, float height, int plane) {
  float at = -shelf.width / 2 + 0.03f;
  const float stop = shelf.width / 2 - 0.05f - layout.uniform(0, 0.4f) * shelf.width;
  while (at < stop) {
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
    if (turned.sizes().z() > 0.29) continue;
    const double front = double(shelf.depth) / 2 - double(layout.uniform(0.015f, 0.05f));
    const Eigen::Vector3d to(front - turned.max().x(), double(at) - turned.min().y(),
                             double(height) - turned.min().z());
    layout.add_object(std::move(book), T_wo * SE3(R, to), plane);
    at += thick + layout.uniform(0.0005f, 0.004f);
    if (layout.chance(0.08f)) at += layout.uniform(0.03f, 0.15f);
  }
}

}  // namespace cairn
