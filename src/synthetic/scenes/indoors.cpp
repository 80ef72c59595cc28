#include "cairn/synthetic/scenes/indoors.h"

#include "cairn/synthetic/primitives.h"

namespace cairn {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kSkirting = 0.08f;

}  // namespace

SE3 Room::at_wall(int wall, float x, const Model& model) const {
  const SE3 T = this->wall(wall);
  const Eigen::Vector3d at =
      T * Eigen::Vector3d(double(x), 0, 0.03 - double(extent(model).min().x()));
  const Eigen::Vector3d front = T.rotation() * Eigen::Vector3d::UnitZ();
  return standing(at.cast<float>(), float(std::atan2(front.y(), front.x())));
}

Model make_long_table(Layout& layout) {
  Model table = make_model("dining table", layout.seed());
  while (table.symmetry == Symmetry::kAnyTurn) table = make_model("dining table", layout.seed());
  return table;
}

Model make_low_chair(Layout& layout) {
  Model chair = make_model("chair", layout.seed());
  for (int i = 0; i < 20 && extent(chair).max().z() > 0.95f; ++i) {
    chair = make_model("chair", layout.seed());
  }
  return chair;
}

void lay_things(Layout& layout, int plane, std::initializer_list<const char*> classes,
                std::optional<float> yaw) {
  const float low = yaw ? *yaw - 0.4f : 0, high = yaw ? *yaw + 0.4f : 2 * float(M_PI);
  Eigen::AlignedBox3d box;
  for (const auto& corner : layout.plane(plane).outline) box.extend(corner);
  const Vector3f corner = box.min().cast<float>(), size = box.sizes().cast<float>();
  Tray tray(corner, {size.x(), 0, 0}, {0, size.y(), 0});
  for (const char* name : classes) {
    Model model = make_model(name, layout.seed());
    const auto T_wo = tray.find(model, layout, low, high);
    if (T_wo) layout.add_object(std::move(model), *T_wo, plane);
  }
}

Material patterned(Pattern pattern, std::uint64_t seed, float gloss, float shininess) {
  Material material;
  material.colour = Colour::Ones();
  material.texture = make_texture(pattern, seed);
  material.gloss = gloss;
  material.shininess = shininess;
  return material;
}

Material plain(const Colour& colour, float gloss, float shininess) {
  Material material;
  material.colour = colour;
  material.gloss = gloss;
  material.shininess = shininess;
  return material;
}

Room::Room(Layout& layout, const Vector3f& size, Pattern floor, Pattern wall)
    : layout_(layout), size_(size) {
  const float x = size.x() / 2, y = size.y() / 2, z = size.z();
  const bool shiny = floor != Pattern::kCarpet;
  Mesh ground;
  add_quad(ground, {-x, -y, 0}, {2 * x, 0, 0}, {0, 2 * y, 0},
           ground.add(patterned(floor, layout.seed(), shiny ? 0.35f : 0, 40)));
  layout.add_surface("floor", std::move(ground));
  floor_ = layout.add_plane("floor", {{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}});
  Mesh top;
  add_quad(top, {-x, -y, z}, {0, 2 * y, 0}, {2 * x, 0, 0}, top.add(plain({0.82f, 0.82f, 0.8f})));
  layout.add_surface("ceiling", std::move(top));
  layout.add_plane("ceiling", {{-x, -y, z}, {-x, y, z}, {x, y, z}, {x, -y, z}});
  const Material paper = patterned(wall, layout.seed());
  const Material accent = patterned(Pattern::kPlaster, layout.seed());
  const int accent_wall = layout.below(4);
  const Colour skirting = Colour::Constant(layout.uniform(0.4f, 0.8f));
  for (int i = 0; i < 4; ++i) {
    const float w = wall_width(i) / 2;
    const SE3 T = this->wall(i);
    Mesh mesh;
    add_picture(mesh, {-w, z, 0}, {2 * w, 0, 0}, {0, -z, 0},
                mesh.add(i == accent_wall ? accent : paper), {1.7f * float(i), 0});
    layout.add_surface("wall", std::move(mesh), T);
    std::vector<Vector3f> outline;
    for (const Vector3f& corner :
         {Vector3f(-w, 0, 0), Vector3f(w, 0, 0), Vector3f(w, z, 0), Vector3f(-w, z, 0)}) {
      outline.push_back((T * corner.cast<double>()).cast<float>());
    }
    layout.add_plane("wall", outline);
    Mesh board;
    add_box(board, {0, kSkirting / 2, 0.006f}, {2 * w, kSkirting, 0.012f},
            board.add(plain(skirting, 0.2f)));
    layout.add_surface("skirting", std::move(board), T);
  }
}

SE3 Room::wall(int index) const {
  const double angle = index * M_PI / 2;
  const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0);
  Eigen::Matrix3d R;
  R.col(2) = -out;
  R.col(1) = Eigen::Vector3d::UnitZ();
  R.col(0) = R.col(1).cross(R.col(2));
  return SE3(R, out * 0.5 * double(index % 2 == 0 ? size_.x() : size_.y()));
}

void Room::add_window(int wall, float x, float y, float width, float height,
                      const Colour& daylight) {
  const SE3 T = this->wall(wall);
  const float bar = 0.05f, w = width / 2, h = height / 2;
  Mesh frame;
  const auto paint = frame.add(plain(Colour::Constant(0.8f), 0.3f));
  for (const float side : {-1.f, 1.f}) {
    add_box(frame, {x + side * w, y, 0.03f}, {bar, height + bar, 0.06f}, paint);
    add_box(frame, {x, y + side * h, 0.03f}, {width + bar, bar, 0.06f}, paint);
  }
  add_box(frame, {x, y, 0.025f}, {bar * 0.7f, height, 0.05f}, paint);
  add_box(frame, {x, y - h - 0.03f, 0.07f}, {width + 0.2f, 0.03f, 0.14f}, paint);
  layout_.add_surface("window", std::move(frame), T);
  Mesh pane;
  Material view = patterned(Pattern::kView, layout_.seed());
  view.colour = Colour::Zero();
  view.emission = 0.3f * daylight;  // less than it lights with, so that there is something to see
  // The picture of the world outside, as large as the pane.
  auto scaled = std::make_shared<Texture>(*view.texture);
  scaled->texels_per_metre *=
      view_size.x() / std::max(width, height * view_size.x() / view_size.y());
  view.texture = scaled;
  add_picture(pane, {x - w, y + h, 0.012f}, {width, 0, 0}, {0, -height, 0}, pane.add(view));
  layout_.add_surface("window", std::move(pane), T);
  AreaLight light;
  light.centre = (T * Vector3f(x, y, 0.08f).cast<double>()).cast<float>();
  light.u = (T.rotation() * Eigen::Vector3d(double(w), 0, 0)).cast<float>();
  light.v = (T.rotation() * Eigen::Vector3d(0, double(h), 0)).cast<float>();
  light.radiance = daylight;
  layout_.scene().lights.push_back(light);
}

void Room::add_poster(int wall, float x, float y, float scale) {
  const float w = scale * poster_size.x(), h = scale * poster_size.y();
  Mesh mesh;
  Material print = patterned(Pattern::kPoster, layout_.seed(), 0.1f);
  auto scaled = std::make_shared<Texture>(*print.texture);
  scaled->texels_per_metre /= scale;
  print.texture = scaled;
  const auto paper = mesh.add(print);
  const auto wood = mesh.add(plain(Colour::Constant(layout_.uniform(0.03f, 0.6f)), 0.3f));
  const bool framed = layout_.chance(0.5f);
  add_picture(mesh, {x - w / 2, y + h / 2, framed ? 0.012f : 0.001f}, {w, 0, 0}, {0, -h, 0}, paper);
  if (framed) {
    for (const float side : {-1.f, 1.f}) {
      add_box(mesh, {x + side * w / 2, y, 0.01f}, {0.02f, h + 0.02f, 0.02f}, wood);
      add_box(mesh, {x, y + side * h / 2, 0.01f}, {w + 0.02f, 0.02f, 0.02f}, wood);
    }
  }
  layout_.add_surface("poster", std::move(mesh), this->wall(wall));
}

Mesh door_mesh(const Colour& colour) {
  constexpr float kWidth = 0.9f, kHeight = 2.05f, kFrame = 0.07f;
  Mesh mesh;
  const auto leaf = mesh.add(plain(colour, 0.25f, 50));
  const auto frame = mesh.add(plain(0.8f * colour + Colour::Constant(0.1f), 0.25f, 50));
  const auto metal = mesh.add(plain(Colour::Constant(0.45f), 0.8f, 120));
  add_box(mesh, {0, kHeight / 2, 0.01f}, {kWidth, kHeight, 0.02f}, leaf);
  for (const float side : {-1.f, 1.f}) {
    add_box(mesh, {side * (kWidth + kFrame) / 2, (kHeight + kFrame) / 2, 0.02f},
            {kFrame, kHeight + kFrame, 0.04f}, frame);
  }
  add_box(mesh, {0, kHeight + kFrame / 2, 0.02f}, {kWidth, kFrame, 0.04f}, frame);
  add_box(mesh, {0.37f, 1.03f, 0.05f}, {0.12f, 0.02f, 0.02f}, metal);
  add_box(mesh, {0.4f, 1.02f, 0.03f}, {0.04f, 0.2f, 0.012f}, metal);
  return mesh;
}

void Room::add_door(int wall, float x, const Colour& colour) {
  layout_.add_surface("door", door_mesh(colour),
                      this->wall(wall) * SE3(Eigen::Quaterniond::Identity(), {double(x), 0, 0}));
}

void Room::add_ceiling_lamp(const Vector2f& at, const Vector2f& size, const Colour& radiance) {
  const Vector3f centre(at.x(), at.y(), size_.z() - 0.06f);
  Mesh body;
  add_box(body, {at.x(), at.y(), size_.z() - 0.029f}, {size.x() + 0.04f, size.y() + 0.04f, 0.058f},
          body.add(plain(Colour::Constant(0.7f))));
  layout_.add_surface("lamp", std::move(body));
  layout_.add_lamp(centre, {0, size.y() / 2, 0}, {size.x() / 2, 0, 0}, radiance,
                   Colour::Constant(1.6f).cwiseMin(radiance));
}

}  // namespace cairn
