#include <algorithm>
#include <cmath>
#include <span>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

constexpr std::uint32_t kGreens[] = {0x3f7a38, 0x4d8f42, 0x6f9a45, 0x2f6a38, 0x86a84a, 0x5a8f5f};
const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

Print leaf_skin(float width, float length, const Colour& colour, Dice& dice) {
  Canvas skin(width, length, 500 / length, colour);
  skin.grain(0.3f, 0.3f * width, 0.05f * length, dice.seed());
  const Colour vein = colour * 1.7f;
  for (const float x : {0.25f, 0.75f}) {  // u runs around the blade: both its sides
    skin.line(x * width, 0, x * width, length, 0.03f * width, vein);
    for (int i = 1; i < 9; ++i)
      for (const float side : {-1.0f, 1.0f})
        skin.line(x * width, 0.11f * length * float(i), (x + side * 0.2f) * width,
                  0.11f * length * float(i) - 0.08f * length, 0.012f * width, vein);
  }
  return skin.texture();
}

// A leaf's blade along a path, thin, widest at `widest` (0 to 1) of its length.
Mesh blade(const Path& path, float width, float widest) {
  std::vector<float> scales;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const float t = float(i) / float(path.size() - 1);
    const float before = t / widest, after = (1 - t) / (1 - widest);
    scales.push_back(std::max(0.06f, std::sin(1.5708f * std::min({before, after, 1.0f}))));
  }
  const Outline rhomb{{width / 2, 0},
                      {0, 0.012f * width + 0.0004f},
                      {-width / 2, 0},
                      {0, -0.012f * width - 0.0004f}};
  const Eigen::Vector3f ahead = path[1] - path[0];
  const Eigen::Vector3f side = ahead.cross(kUp).norm() > 1e-4f ? Eigen::Vector3f(ahead.cross(kUp))
                                                               : Eigen::Vector3f::UnitY();
  return sweep(path, rhomb, scales, side.normalized());
}

}  // namespace

Model make_potted_plant(Dice& dice) {
  Assembly plant("potted plant");
  const bool large = dice.chance(0.5f);
  const float pot_r = large ? dice.uniform(0.13f, 0.19f) : dice.uniform(0.055f, 0.09f);
  const float pot_h = pot_r * dice.uniform(1.5f, 2.0f), foot = pot_r * dice.uniform(0.65f, 0.95f);
  const float reach = pot_h * dice.uniform(1.5f, 2.6f);
  const auto pot = plant.material(
      {.colour = dice.chance(0.4f) ? srgb(0xb5673f) : dice.colour(kGlazes), .gloss = 0.2f});
  const auto soil = plant.material({.colour = srgb(0x3a2a1d)});
  const Profile profile{{0, 0, 0},
                        {foot, 0, 0},
                        {0.96f * pot_r, 0.82f * pot_h, 0},
                        {pot_r * 1.04f, 0.82f * pot_h, 0},
                        {pot_r * 1.06f, pot_h, 0},
                        {0.95f * pot_r, pot_h, 0},
                        {0.93f * pot_r, 0.9f * pot_h, 1},
                        {0, 0.92f * pot_h, 1}};
  plant.add(lathe(round_profile(profile, 0.05f * pot_r, 2), 28), {pot, soil});

  // Kinds: long blades from the soil (a dracaena), or broad leaves on stalks (a rubber plant).
  const bool broad = dice.chance(0.55f);
  const int leaves = broad ? 24 + dice.below(14) : 26 + dice.below(16);
  const float width = reach * (broad ? dice.uniform(0.22f, 0.32f) : dice.uniform(0.06f, 0.1f));
  const float blade_length = reach * (broad ? dice.uniform(0.4f, 0.5f) : 1.0f);
  const Colour green = dice.colour(kGreens);
  std::uint32_t skins[3];
  for (int i = 0; i < 3; ++i)
    skins[i] = plant.material({.colour = Colour::Constant(0.75f + 0.2f * float(i)),
                               .texture = leaf_skin(2 * width, blade_length, green, dice),
                               .gloss = 0.2f});
  const auto stalk = plant.material({.colour = green * 0.7f});
  for (int i = 0; i < leaves; ++i) {
    const float t = float(i) / float(leaves), azimuth = 137.508f * float(i) + dice.uniform(-15, 15);
    const float out = 0.15f + 0.85f * (1 - t) * dice.uniform(0.8f, 1.15f);
    const float up = 0.45f + 0.55f * t;
    const auto place = turned(kUp, azimuth);
    const float z0 = 0.9f * pot_h, lean = 0.55f * reach * out, rise = reach * up;
    const Path curve{{0.1f * pot_r, 0, z0},
                     {0.35f * lean, 0, z0 + 0.55f * rise},
                     {0.75f * lean, 0, z0 + 0.95f * rise},
                     {1.15f * lean, 0, z0 + (broad ? 0.92f : 0.85f) * rise},
                     {1.5f * lean, 0, z0 + (broad ? 0.72f : 0.6f) * rise}};
    Path path = smooth(curve, 4);
    if (!broad) {
      plant.add(blade(path, width, 0.35f), skins[i % 3], place);
      continue;
    }
    const Path stem(path.begin(), path.begin() + 9), leaf(path.begin() + 8, path.end());
    plant.add(tube(stem, 0.012f * reach, 5), stalk, place);
    plant.add(blade(leaf, width * dice.uniform(0.7f, 1.1f), 0.45f), skins[i % 3], place);
  }
  return std::move(plant).finish();
}

namespace {

struct Bough {
  Eigen::Vector3f centre;
  float radius;
};

// How far the crown reaches from its middle: to the outermost of the boughs' balls. One surface
// around all of them, so that none of it lies in another's dark inside.
float reach(std::span<const Bough> boughs, const Eigen::Vector3f& direction) {
  float far = 0;
  for (const Bough& bough : boughs) {
    const float along = bough.centre.dot(direction);
    const float off = bough.centre.squaredNorm() - along * along;
    if (off < bough.radius * bough.radius)
      far = std::max(far, along + std::sqrt(bough.radius * bough.radius - off));
  }
  return far;
}

// Leaves that stick out of the crown: rhombs that are seen from both sides.
Mesh loose_leaves(std::span<const Bough> boughs, int count, float size, Dice& dice) {
  Mesh mesh;
  const auto random = [&] {
    return Eigen::Vector3f(dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(-1, 1));
  };
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f out = (random() + Eigen::Vector3f(1e-3f, 0, 0)).normalized();
    const Eigen::Vector3f middle = reach(boughs, out) * dice.uniform(0.9f, 1.06f) * out;
    const Eigen::Vector3f facing = (out + 0.9f * random()).normalized();
    const Eigen::Vector3f u = facing.unitOrthogonal() * size * dice.uniform(0.7f, 1.3f);
    const Eigen::Vector3f v = facing.cross(u) * 0.6f;
    const Eigen::Vector2f uv(dice.uniform(0, 1), dice.uniform(0, 1));
    for (const float side : {1.0f, -1.0f}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Eigen::Vector2f& c : {Eigen::Vector2f(1, 0), {0, side}, {-1, 0}, {0, -side}})
        mesh.vertices.push_back({middle + c.x() * u + c.y() * v, side * facing, uv + size * c});
      mesh.triangles.push_back({first, first + 1, first + 2, 0});
      mesh.triangles.push_back({first, first + 2, first + 3, 0});
    }
  }
  return mesh;
}

Print foliage_skin(const Colour& colour, Dice& dice) {
  Canvas skin(1.2f, 1.2f, 420, colour * 0.3f);
  for (int i = 0; i < 2600; ++i) {  // leaf upon leaf, the last ones in the light
    const float x = dice.uniform(0, 1.2f), y = dice.uniform(0, 1.2f), a = dice.uniform(0, 6.283f);
    const float l = dice.uniform(0.02f, 0.045f), w = 0.4f * l;
    const Eigen::Vector2f c(x, y), u(std::cos(a), std::sin(a)), v(-u.y(), u.x());
    const float light = (0.5f + 0.9f * float(i) / 2600) * dice.uniform(0.7f, 1.3f);
    skin.polygon({c + l * u, c + w * v, c - l * u, c - w * v}, colour * light);
  }
  return skin.texture();
}

}  // namespace

Model make_tree(Dice& dice) {
  Assembly tree("tree");
  const float height = dice.uniform(4.0f, 8.0f), trunk_h = height * dice.uniform(0.3f, 0.42f);
  const float trunk_r = height * dice.uniform(0.017f, 0.026f),
              crown = height * dice.uniform(0.2f, 0.3f);
  Canvas rind(0.8f, 1.6f, 250, srgb(0x5b4a3a));
  rind.grain(0.45f, 0.03f, 0.25f, dice.seed());
  const auto bark = tree.material({.colour = Colour::Ones(), .texture = rind.texture()});
  const auto leaves = tree.material(
      {.colour = Colour::Ones(), .texture = foliage_skin(dice.colour(kGreens), dice)});
  const float sway = 0.03f * height;
  const Path trunk = smooth({{0, 0, 0},
                             {dice.uniform(-sway, sway), dice.uniform(-sway, sway), 0.5f * trunk_h},
                             {dice.uniform(-sway, sway), dice.uniform(-sway, sway), 1.2f * trunk_h},
                             {0, 0, 0.75f * height}},
                            4);
  std::vector<float> scales;
  for (std::size_t i = 0; i < trunk.size(); ++i)
    scales.push_back(i == 0 ? 1.5f : 1.1f - 0.8f * float(i) / float(trunk.size()));
  tree.add(sweep(trunk, circle(trunk_r, 12), scales, Eigen::Vector3f::UnitY(), 75), bark);
  const Eigen::Vector3f middle = (0.5f * (height + trunk_h) + 0.04f * height) * kUp;
  std::vector<Bough> boughs{{Eigen::Vector3f::Zero(), 0.9f * crown}};
  const float tall = 0.36f * (height - trunk_h);
  for (int i = 0; i < 22; ++i) {
    const float azimuth = 2.39996f * float(i), up = 2 * (float(i) + 0.5f) / 22 - 1;
    const float around = 0.8f * crown * std::sqrt(1 - up * up);
    boughs.push_back({{around * std::cos(azimuth), around * std::sin(azimuth), tall * up},
                      crown * dice.uniform(0.35f, 0.6f)});
  }
  Mesh mass = ball(1, 36);
  deform(
      mass,
      [&](const Eigen::Vector3f& p) {
        const Eigen::Vector3f out = (p - kUp).normalized();
        return Eigen::Vector3f(0.9f * reach(boughs, out) * out);
      },
      80);
  const auto place = at(0, 0, middle.z());
  tree.add(mass, leaves, place);
  tree.add(loose_leaves(boughs, 1300, 0.018f * height, dice), leaves, place);
  return std::move(tree).finish();
}

}  // namespace cairn
