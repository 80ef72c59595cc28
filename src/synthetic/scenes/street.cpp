// Some blocks of a town: houses, pavements, parked cars; a car with two cameras drives through.
#include <map>

#include "cairn/synthetic/primitives.h"
#include "cairn/synthetic/scenes/hand_motion.h"
#include "cairn/synthetic/scenes/indoors.h"
#include "cairn/synthetic/scenes/makers.h"
#include "cairn/synthetic/scenes/route.h"

namespace cairn {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kPitch = 64;     // metres from street to street
constexpr float kRoad = 5.2f;    // half the width of a road
constexpr float kHouseLine = 8;  // from the middle of the road to the houses
constexpr float kHouse = 12, kDepth = 9;
constexpr float kKerb = 0.13f;
constexpr double kLane = 2;  // from the middle of the road

// Crossings that the car passes, in units of the pitch.
std::vector<Vector2d> crossings(Layout& layout) {
  std::vector<Vector2d> nodes = {{0, -0.7}, {0, 1}};
  const double side = layout.chance(0.5f) ? 1 : -1;
  nodes.emplace_back(side, 1);
  if (layout.chance(0.5f)) {
    nodes.emplace_back(side, 2.4);
  } else {
    nodes.emplace_back(side, -0.4);
  }
  for (auto& node : nodes) node *= double(kPitch);
  return nodes;
}

Vector2d right_of(const Vector2d& direction) { return {direction.y(), -direction.x()}; }

// The way in the right lane along the middle of the streets.
std::vector<Vector2d> right_lane(const std::vector<Vector2d>& nodes) {
  std::vector<Vector2d> lane = nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i > 0) lane[i] += kLane * right_of((nodes[i] - nodes[i - 1]).normalized());
    if (i + 1 < nodes.size()) lane[i] += kLane * right_of((nodes[i + 1] - nodes[i]).normalized());
  }
  return lane;
}

double distance_to_route(const Vector2d& p, const std::vector<Vector2d>& nodes) {
  double nearest = 1e9;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const Vector2d along = nodes[i] - nodes[i - 1];
    const double a = std::clamp((p - nodes[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - nodes[i - 1] - a * along).norm());
  }
  return nearest;
}

struct Fronts {
  std::vector<Material> walls;
  Material roof;
};

// A house whose front's lower edge runs from `left` along `right` (unit) as seen from the street.
// It has neither sides nor back: around a block the houses stand wall to wall and are equally tall.
void add_house(Layout& layout, const Vector2f& left, const Vector2f& right, float height,
               float rise, const Fronts& fronts) {
  constexpr float kEaves = 0.5f, kThick = 0.1f;
  const Vector3f r(right.x(), right.y(), 0), up(0, 0, 1);
  const Vector3f back = up.cross(r);  // away from the street
  const Vector3f base(left.x(), left.y(), kKerb);
  Mesh mesh;
  const auto wall = mesh.add(fronts.walls[std::size_t(layout.below(int(fronts.walls.size())))]);
  const auto roof = mesh.add(fronts.roof);
  add_picture(mesh, base + height * up, kHouse * r, -height * up, wall,
              {0, facade_size.y() - height});
  const Vector3f ridge = base + (height + rise) * up + 0.5f * kDepth * back;
  const Vector3f eaves = base + height * up - kEaves * back;
  const Vector3f below = kThick * up;
  add_quad(mesh, eaves, kHouse * r, ridge - eaves, roof);
  add_quad(mesh, eaves - below, ridge - eaves, kHouse * r, roof);
  add_quad(mesh, eaves - below, kHouse * r, below, roof);  // the gutter
  layout.add_surface("building", std::move(mesh));
  layout.add_plane("building",
                   {base, base + kHouse * r, base + kHouse * r + height * up, base + height * up});
}

// Pavement and houses around one block whose corner next to the crossing is `origin`.
void add_block(Layout& layout, const Vector2f& origin, const Material& paving,
               const Fronts& fronts) {
  const float inner = kPitch - 2 * kRoad;
  const Vector3f low(origin.x() + kRoad, origin.y() + kRoad, 0);
  Mesh slab;
  add_box(slab, low + Vector3f(inner / 2, inner / 2, kKerb / 2), {inner, inner, kKerb},
          slab.add(paving));
  const int thing = layout.add_surface("sidewalk", std::move(slab));
  layout.add_top(thing, "sidewalk");
  const float side = kPitch - 2 * kHouseLine;
  const Vector2f corner = origin + Vector2f::Constant(kHouseLine);
  // Seen from the street, each side runs to the right.
  const Vector2f starts[] = {corner, corner + Vector2f(side, 0), corner + Vector2f(side, side),
                             corner + Vector2f(0, side)};
  const Vector2f rights[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  const int count = int(side / kHouse);
  const float height = layout.one_of({9.f, 12.f, 12.f}), rise = layout.uniform(1.5f, 3.5f);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < count; ++k) {
      add_house(layout, starts[i] + float(k) * kHouse * rights[i], rights[i], height, rise, fronts);
    }
  }
}

// Whether a place on a street is on a crossing, or nearer to one than `margin` metres.
bool on_crossing(const Vector2d& p, double margin) {
  const Vector2d cells = p / double(kPitch);
  const Vector2d off = (cells - cells.array().round().matrix()).cwiseAbs() * double(kPitch);
  return off.maxCoeff() < margin;
}

// What stands along one street from `from` to `to`: cars, trees, lamps.
void line_street(Layout& layout, const Vector2d& from, const Vector2d& to, int road) {
  const Vector2d along = (to - from).normalized();
  const double length = (to - from).norm();
  const auto heading = float(std::atan2(along.y(), along.x()));
  for (const double side : {1.0, -1.0}) {
    const Vector2d out = side * right_of(along);
    auto place = [&](double s, double off, double z) {
      const Vector2d p = from + s * along + off * out;
      return Vector3f(float(p.x()), float(p.y()), float(z));
    };
    for (double s = 13; s < length - 13; s += double(layout.uniform(6.2f, 11.0f))) {
      if (layout.chance(0.25f) || on_crossing(from + s * along, 12)) continue;
      Model car = make_model(layout.chance(0.06f) ? "truck" : "car", layout.seed());
      const Eigen::Vector3f size = extent(car).sizes();
      if (size.y() > 2.35f || size.x() > 6) continue;
      const float turn = (side > 0 ? 0 : float(M_PI)) + layout.uniform(-0.03f, 0.03f);
      layout.add_object(std::move(car),
                        standing(place(s, double(kRoad - 0.15f - size.y() / 2), 0), heading + turn),
                        road);
    }
    for (double s = 9; s < length - 9; s += double(layout.uniform(14, 20))) {
      if (on_crossing(from + s * along, 8) || on_crossing(from + (s + 6) * along, 7)) continue;
      layout.add_object(
          make_model("tree", layout.seed()),
          standing(place(s, double(kRoad) + 0.7, double(kKerb)), layout.uniform(0, 6)), {});
      Mesh pole;
      const auto steel = pole.add(plain(Colour::Constant(0.16f), 0.4f));
      add_cylinder(pole, {0, 0, 0}, 0.07f, 0.05f, 6, 10, steel);
      add_box(pole, {-0.6f, 0, 6}, {1.3f, 0.12f, 0.08f}, steel);
      layout.add_surface("pole", std::move(pole),
                         standing(place(s + 6, double(kRoad) + 0.4, double(kKerb)),
                                  heading + (side > 0 ? -1.5708f : 1.5708f)));
    }
  }
}

void mark_lanes(Layout& layout, const Vector2d& from, const Vector2d& to) {
  const Vector2d along = (to - from).normalized();
  Mesh mesh;
  const auto paint = mesh.add(plain(Colour::Constant(0.62f)));
  const Vector3f a(float(along.x()), float(along.y()), 0);
  const Vector3f r(a.y(), -a.x(), 0);
  for (double s = 10; s < (to - from).norm() - 10; s += 9) {
    const Vector2d p = from + s * along;
    if (on_crossing(p, 9)) continue;
    const Vector3f at(float(p.x()), float(p.y()), 0.006f);
    add_quad(mesh, at - 0.07f * r, 0.14f * r, 3.f * a, paint);
  }
  layout.add_surface("road", std::move(mesh));
}

// A small bright rectangle far away.
AreaLight sun(Layout& layout) {
  constexpr float kFar = 400, kHalf = 5, kStrength = 1.25f;
  const float azimuth = layout.uniform(0, 6.28f), height = layout.uniform(0.6f, 1.1f);
  const Vector3f to(std::cos(azimuth) * std::cos(height), std::sin(azimuth) * std::cos(height),
                    std::sin(height));
  AreaLight light;
  light.centre = kFar * to;
  const Vector3f u = Vector3f::UnitZ().cross(to).normalized();
  light.u = kHalf * u;
  light.v = kHalf * u.cross(to);  // u x v = -to
  light.radiance =
      kStrength * float(M_PI) * kFar * kFar / (4 * kHalf * kHalf) * Colour(1.0f, 0.93f, 0.82f);
  return light;
}

}  // namespace

Scene make_street(std::uint64_t seed) {
  Layout layout("street", seed);
  const auto nodes = crossings(layout);
  Eigen::AlignedBox2d box;
  for (const auto& node : nodes) box.extend(node);
  const Vector2f low = box.min().cast<float>() - Vector2f::Constant(1.6f * kPitch);
  const Vector2f size = box.sizes().cast<float>() + Vector2f::Constant(3.2f * kPitch);
  Mesh ground;
  add_quad(ground, {low.x(), low.y(), 0}, {size.x(), 0, 0}, {0, size.y(), 0},
           ground.add(patterned(Pattern::kAsphalt, layout.seed(), 0.08f, 20)));
  layout.add_surface("road", std::move(ground));
  const Vector3f a(low.x(), low.y(), 0), u(size.x(), 0, 0), v(0, size.y(), 0);
  const int road = layout.add_plane("road", {a, a + u, a + u + v, a + v});
  Fronts fronts;
  for (int i = 0; i < 9; ++i) {
    fronts.walls.push_back(patterned(Pattern::kFacade, layout.seed(), 0.05f));
  }
  fronts.roof = plain({0.24f, 0.13f, 0.1f});
  const Material paving = patterned(Pattern::kPaving, layout.seed());
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 4; ++j) {
      const Vector2d middle = double(kPitch) * Vector2d(i + 0.5, j + 0.5);
      if (distance_to_route(middle, nodes) > 1.3 * double(kPitch)) continue;
      add_block(layout, kPitch * Vector2f(float(i), float(j)), paving, fronts);
    }
  }
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    line_street(layout, nodes[i - 1], nodes[i], road);
    mark_lanes(layout, nodes[i - 1], nodes[i]);
  }
  Scene& scene = layout.scene();
  scene.lights.push_back(sun(layout));
  scene.sky = layout.uniform(0.85f, 1.15f) * Colour(0.42f, 0.58f, 0.86f);
  scene.ambient = Colour::Constant(0.06f);
  const Route route(right_lane(nodes), 8, {8, 4.5});
  const HandMotion sway(seed + 400);
  scene.path = [route, sway](double t) {
    const Vector2d at = route.at(t);
    const double heading = route.heading(t) + 0.004 * sway.wander(t, 0, 5);
    const Eigen::Vector3d position(at.x(), at.y(), 1.65 + 0.012 * sway.wander(t, 1, 1.1));
    const Eigen::Vector3d look(std::cos(heading), std::sin(heading),
                               -0.02 + 0.008 * sway.wander(t, 2, 1.3));
    return looking_at(position, position + look, 0.006 * sway.wander(t, 3, 1.7));
  };
  scene.fps = 10;
  scene.duration = route.duration();
  return std::move(layout).finish();
}

}  // namespace cairn
