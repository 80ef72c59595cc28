// A corridor with a bend: plain walls, doors, lamps on the ceiling. There is hardly anything for
// points to hold on to, and that is its purpose.
#include "cairn/synthetic/primitives.h"
#include "cairn/synthetic/scenes/hand_motion.h"
#include "cairn/synthetic/scenes/indoors.h"
#include "cairn/synthetic/scenes/makers.h"
#include "cairn/synthetic/scenes/route.h"

namespace cairn {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

struct Plan {
  float width, first, second, height;  // metres: inside width, lengths of both legs

  // Counter-clockwise; the first leg runs along +y, the second from its end along +x.
  std::vector<Vector2f> corners() const {
    const float w = width / 2;
    return {
        {-w, 0},    {w, 0}, {w, first - width}, {w + second, first - width}, {w + second, first},
        {-w, first}};
  }
};

// The wall's frame as Room has it: x to the right from inside, y up, z into the corridor.
SE3 wall_frame(const Vector2f& from, const Vector2f& to) {
  // With the inside on the left of from -> to, the viewer inside sees `to` on the left.
  const Eigen::Vector2d along = (from - to).normalized().cast<double>();
  const Eigen::Vector2f middle = 0.5f * (from + to);
  Eigen::Matrix3d R;
  R.col(0) = Eigen::Vector3d(along.x(), along.y(), 0);
  R.col(1) = Eigen::Vector3d::UnitZ();
  R.col(2) = R.col(0).cross(R.col(1));
  return SE3(R, {double(middle.x()), double(middle.y()), 0});
}

void add_shell(Layout& layout, const Plan& plan) {
  const auto corners = plan.corners();
  const float w = plan.width / 2, h = plan.height;
  const Material plaster = patterned(Pattern::kPlaster, layout.seed());
  const Material lino = plain(layout.uniform(0.8f, 1.1f) * Colour(0.30f, 0.32f, 0.31f), 0.4f, 60);
  for (const bool ground : {true, false}) {
    Mesh mesh;
    const auto paint = mesh.add(ground ? lino : plain(Colour::Constant(0.8f)));
    const float z = ground ? 0 : h;
    auto tile = [&](float x0, float y0, float x1, float y1) {
      const Vector3f u(x1 - x0, 0, 0), v(0, y1 - y0, 0);
      add_quad(mesh, {x0, y0, z}, ground ? u : v, ground ? v : u, paint);
    };
    tile(-w, 0, w, plan.first - plan.width);
    tile(-w, plan.first - plan.width, w, plan.first);
    tile(w, plan.first - plan.width, w + plan.second, plan.first);
    const std::string label = ground ? "floor" : "ceiling";
    layout.add_surface(label, std::move(mesh));
    std::vector<Vector3f> outline;
    for (const auto& corner : corners) outline.emplace_back(corner.x(), corner.y(), z);
    if (!ground) std::reverse(outline.begin(), outline.end());
    layout.add_plane(label, outline);
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2f from = corners[i], to = corners[(i + 1) % corners.size()];
    const SE3 T = wall_frame(from, to);
    const float half = (to - from).norm() / 2;
    Mesh mesh, board;
    add_picture(mesh, {-half, h, 0}, {2 * half, 0, 0}, {0, -h, 0}, mesh.add(plaster));
    layout.add_surface("wall", std::move(mesh), T);
    add_box(board, {0, 0.05f, 0.006f}, {2 * half, 0.1f, 0.012f},
            board.add(plain(Colour::Constant(0.25f), 0.2f)));
    layout.add_surface("skirting", std::move(board), T);
    layout.add_plane("wall", {{from.x(), from.y(), 0},
                              {from.x(), from.y(), h},
                              {to.x(), to.y(), h},
                              {to.x(), to.y(), 0}});
  }
}

void add_doors(Layout& layout, const Plan& plan) {
  const auto corners = plan.corners();
  const Colour paint = layout.one_of(
      {Colour(0.36f, 0.26f, 0.17f), Colour(0.5f, 0.52f, 0.55f), Colour(0.25f, 0.33f, 0.42f)});
  for (const std::size_t i : {1u, 2u, 4u, 5u}) {
    const Vector2f from = corners[i], to = corners[(i + 1) % corners.size()];
    const float half = (to - from).norm() / 2;
    for (float x = -half + layout.uniform(1.2f, 2.2f); x < half - 0.8f;
         x += layout.uniform(2.4f, 4.2f)) {
      layout.add_surface(
          "door", door_mesh(paint),
          wall_frame(from, to) * SE3(Eigen::Quaterniond::Identity(), {double(x), 0, 0}));
    }
  }
}

void add_lamps(Layout& layout, const Plan& plan) {
  const Colour light = layout.uniform(0.8f, 1.2f) * Colour(8, 7.8f, 7.2f);
  const float z = plan.height - 0.03f, bend = plan.first - plan.width / 2;
  for (float y = 1.5f; y < plan.first - 1; y += 3.2f) {
    layout.add_lamp({0, y, z}, {0, 0.6f, 0}, {0.15f, 0, 0}, light, Colour::Constant(1.8f));
  }
  for (float x = 2.5f; x < plan.second; x += 3.2f) {
    layout.add_lamp({x, bend, z}, {0, 0.15f, 0}, {0.6f, 0, 0}, light, Colour::Constant(1.8f));
  }
}

}  // namespace

Scene make_corridor(std::uint64_t seed) {
  Layout layout("corridor", seed);
  const Plan plan{layout.uniform(1.8f, 2.3f), layout.uniform(10, 12), layout.uniform(9, 11),
                  layout.uniform(2.4f, 2.7f)};
  add_shell(layout, plan);
  add_doors(layout, plan);
  add_lamps(layout, plan);
  Scene& scene = layout.scene();
  scene.ambient = Colour::Constant(0.05f);
  // Something to meet at the bend.
  Model plant = make_model("potted plant", layout.seed());
  const float yaw = layout.uniform(0, 6);
  const Eigen::AlignedBox3f leaves = extent(plant, standing(Vector3f::Zero(), yaw));
  const Vector3f corner(plan.corners()[5].x() + 0.03f, plan.corners()[5].y() - 0.03f, 0);
  layout.add_object(std::move(plant),
                    standing(corner - Vector3f(leaves.min().x(), leaves.max().y(), 0), yaw), 0);
  layout.add_object(make_model("suitcase", layout.seed()),
                    standing({plan.width / 2 + plan.second - 0.5f, plan.first - 0.35f, 0},
                             layout.uniform(-1.8f, -1.3f)),
                    0);
  const double bend = double(plan.first - plan.width / 2);
  const Route route({{0, 1.0}, {0, bend}, {double(plan.second) - 1.2, bend}}, 0.75, {0.95, 0.55});
  const HandMotion hand(seed + 300);
  scene.path = [route, hand](double t) {
    const Eigen::Vector2d at = route.at(t);
    // One looks where one will be soon.
    const double heading = route.heading(t + 0.5) + 0.06 * hand.wander(t, 1, 5);
    const Eigen::Vector3d position(at.x(), at.y(), 1.45 + 0.012 * std::sin(2 * M_PI * 1.8 * t));
    const Eigen::Vector3d look(std::cos(heading), std::sin(heading),
                               -0.12 + 0.04 * hand.wander(t, 2, 6));
    return looking_at(position, position + look, 0.02 * hand.wander(t, 3, 4)) * hand.tremble(t);
  };
  scene.duration = route.duration();
  return std::move(layout).finish();
}

}  // namespace cairn
