#include <algorithm>
#include <cmath>

#include "cairn/synthetic/models/assembly.h"
#include "cairn/synthetic/models/makers.h"
#include "cairn/synthetic/prints/prints.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"

namespace cairn {
namespace {

constexpr float kFullTurn = 6.2831853f;

struct Wall {
  Profile outside;  // from the foot's edge up to the rim
  float height = 0, radius = 0;
};

// The outside of a mug: straight, tapering, bellied or flared.
Wall mug_wall(float height, float radius, Dice& dice) {
  const int kind = dice.below(4);
  const float foot = kind == 0 ? 1.0f : dice.uniform(0.6f, 0.85f);
  const float belly = kind == 2 ? dice.uniform(1.05f, 1.12f) : 0.5f + 0.5f * foot;
  const float bulge = kind == 1 ? 0.5f * (1 + foot) : kind == 3 ? 0.94f : belly;
  const ProfilePoint points[] = {{radius * foot, 0.002f},
                                 {radius * (0.35f * foot + 0.65f * bulge), height * 0.25f},
                                 {radius * (0.15f + 0.85f * bulge), height * 0.55f},
                                 {radius, height}};
  return {smooth_profile(points, kind == 0 ? 1 : 4), height, radius};
}

// A vessel that is open at the top: foot, outside (material 0), rim and inside (material 1).
Profile vessel(const Wall& wall, float thickness) {
  Profile profile{{0, 0.002f, 1}, {0.88f * wall.outside.front().r, 0.002f, 1}};
  profile.push_back({0.9f * wall.outside.front().r, 0, 1});
  profile.push_back({wall.outside.front().r, 0, 0});
  for (ProfilePoint p : wall.outside) {
    p.material = 0;
    if (p.z > 1e-4f) profile.push_back(p);
  }
  profile.back().material = 1;
  const ProfilePoint rim = wall.outside.back();
  for (int k = 1; k <= 4; ++k) {  // half a turn over the lip
    const float angle = kFullTurn / 8 * float(k);
    profile.push_back({rim.r - thickness / 2 * (1 - std::cos(angle)),
                       rim.z + thickness / 2 * std::sin(angle), 1});
  }
  for (auto p = wall.outside.rbegin() + 1; p != wall.outside.rend(); ++p)
    if (p->z > 2.5f * thickness) profile.push_back({p->r - thickness, p->z, 1});
  const float floor_r = std::max(0.3f * rim.r, wall.outside.front().r - 1.6f * thickness);
  profile.push_back({floor_r, 1.5f * thickness, 1});
  profile.push_back({0, 1.5f * thickness, 1});
  return profile;
}

float radius_at(const Profile& outside, float z) {
  for (std::size_t i = 1; i < outside.size(); ++i) {
    if (outside[i].z < z) continue;
    const float t = (z - outside[i - 1].z) / std::max(1e-6f, outside[i].z - outside[i - 1].z);
    return outside[i - 1].r + t * (outside[i].r - outside[i - 1].r);
  }
  return outside.back().r;
}

Mesh handle(const Wall& wall, Dice& dice) {
  const float top = wall.height * dice.uniform(0.78f, 0.9f);
  const float bottom = wall.height * dice.uniform(0.18f, 0.3f);
  const float reach = wall.height * dice.uniform(0.24f, 0.36f);
  const float thick = dice.uniform(0.0045f, 0.006f);
  const float in = 0.0025f;  // the ends are hidden in the wall
  const float r_top = radius_at(wall.outside, top), r_bottom = radius_at(wall.outside, bottom);
  const float out = std::max(r_top, r_bottom) + reach;
  const Path points{{0, r_top - in, top},
                    {0, r_top + 0.55f * reach, top + 0.02f * wall.height},
                    {0, out, 0.35f * bottom + 0.65f * top},
                    {0, out - 0.12f * reach, 0.65f * bottom + 0.35f * top},
                    {0, r_bottom + 0.4f * reach, bottom - 0.01f * wall.height},
                    {0, r_bottom - in, bottom}};
  return sweep(smooth(points, 4), ellipse(1.25f * thick, 0.7f * thick, 10), {},
               Eigen::Vector3f::UnitX(), 75);
}

float run_length(const Profile& profile) {
  float length = 0;
  for (std::size_t i = 1; i < profile.size(); ++i)
    if (profile[i - 1].material == 0)
      length += std::hypot(profile[i].r - profile[i - 1].r, profile[i].z - profile[i - 1].z);
  return length;
}

float widest(const Profile& profile) {
  float radius = 0;
  for (const ProfilePoint& p : profile) radius = std::max(radius, p.r);
  return radius;
}

}  // namespace

Model make_cup(Dice& dice) {
  Assembly cup("cup");
  const Wall wall = mug_wall(dice.uniform(0.08f, 0.11f), dice.uniform(0.036f, 0.046f), dice);
  const Profile profile = vessel(wall, dice.uniform(0.003f, 0.0045f));
  const Colour ground = dice.colour(kGlazes);
  const Colour inner = dice.chance(0.5f) ? ground : dice.colour(kGlazes);
  const float gloss = dice.uniform(0.2f, 0.6f);
  const auto outside = cup.material(
      {.colour = Colour::Ones(),
       .texture = mug_print(kFullTurn * widest(profile), run_length(profile), ground, dice),
       .gloss = gloss,
       .shininess = 60});
  const auto inside = cup.material({.colour = inner, .gloss = gloss, .shininess = 60});
  const auto grip = cup.material({.colour = ground, .gloss = gloss, .shininess = 60});
  cup.add(lathe(profile, 36), {outside, inside});
  cup.add(handle(wall, dice), grip);
  return std::move(cup).finish();
}

Model make_bottle(Dice& dice) {
  Assembly bottle("bottle", Symmetry::kAnyTurn);
  constexpr std::uint32_t kGlass[] = {0x1c2b18, 0x2f4a22, 0x3a1f0e, 0x5a2f12, 0x14110f,
                                      0x9fc4d8, 0xc8d8d2, 0x2d5f8a, 0xb43a2a};
  const float height = dice.uniform(0.2f, 0.32f), radius = dice.uniform(0.030f, 0.043f);
  const float neck = dice.uniform(0.011f, 0.015f), neck_from = dice.uniform(0.74f, 0.82f);
  const float shoulder = dice.uniform(0.5f, 0.66f);
  const float label_from = dice.uniform(0.1f, 0.16f),
              label_to = shoulder - dice.uniform(0.04f, 0.1f);
  const float cap_z = height - dice.uniform(0.018f, 0.03f);
  Profile profile{{0, 0.004f, 0},         {radius * 0.7f, 0.004f, 0},
                  {radius * 0.82f, 0, 0}, {radius * 0.95f, 0.0015f, 0},
                  {radius, 0.007f, 0},    {radius, height * label_from, 0}};
  profile.push_back({radius + 0.0004f, height * label_from, 1});
  profile.push_back({radius + 0.0004f, height * label_to, 0});
  profile.push_back({radius, height * label_to, 0});
  const float drop = neck_from - shoulder, sharpness = dice.uniform(0.25f, 0.65f);
  const ProfilePoint curve[] = {
      {radius, height * shoulder},
      {radius * 0.93f, height * (shoulder + 0.3f * drop)},
      {neck + sharpness * (radius - neck), height * (shoulder + 0.6f * drop)},
      {neck * 1.08f, height * neck_from},
      {neck, cap_z}};
  for (const ProfilePoint& p : smooth_profile(curve, 6)) profile.push_back(p);
  profile.back().material = 2;
  const float cap = neck + dice.uniform(0.001f, 0.003f);
  for (const ProfilePoint& p : {ProfilePoint{cap, cap_z, 2},
                                {cap, height - 0.002f, 2},
                                {cap - 0.002f, height, 2},
                                {0, height, 2}})
    profile.push_back(p);
  const float gloss = dice.uniform(0.5f, 0.9f);
  const auto glass =
      bottle.material({.colour = dice.colour(kGlass), .gloss = gloss, .shininess = 90});
  const auto label =
      bottle.material({.colour = Colour::Ones(),
                       .texture = bottle_label(kFullTurn * (radius + 0.0004f),
                                               height * (label_to - label_from), dice),
                       .gloss = 0.05f});
  const auto lid = bottle.material({.colour = dice.colour(kPrints), .gloss = 0.3f});
  bottle.add(lathe(profile, 32), {glass, label, lid});
  return std::move(bottle).finish();
}

Model make_bowl(Dice& dice) {
  Assembly bowl("bowl", Symmetry::kAnyTurn);
  const float radius = dice.uniform(0.065f, 0.13f), height = radius * dice.uniform(0.6f, 0.95f);
  const float foot = radius * dice.uniform(0.4f, 0.55f), belly = dice.uniform(0.72f, 0.92f);
  const ProfilePoint points[] = {{foot, 0.004f},
                                 {radius * (0.35f + 0.4f * belly), height * 0.22f},
                                 {radius * (0.1f + 0.88f * belly), height * 0.55f},
                                 {radius, height}};
  const Profile profile =
      vessel({smooth_profile(points, 4), height, radius}, dice.uniform(0.003f, 0.006f));
  const Colour ground = dice.colour(kGlazes);
  const float gloss = dice.uniform(0.15f, 0.6f);
  const auto outside = bowl.material(
      {.colour = Colour::Ones(),
       .texture = mug_print(kFullTurn * widest(profile), run_length(profile), ground, dice),
       .gloss = gloss,
       .shininess = 60});
  const auto inside =
      bowl.material({.colour = dice.chance(0.5f) ? ground : dice.colour(kGlazes), .gloss = gloss});
  bowl.add(lathe(profile, 40), {outside, inside});
  return std::move(bowl).finish();
}

Model make_vase(Dice& dice) {
  Assembly vase("vase", Symmetry::kAnyTurn);
  const float height = dice.uniform(0.16f, 0.36f), belly = height * dice.uniform(0.22f, 0.34f);
  const float foot = belly * dice.uniform(0.45f, 0.8f), neck = belly * dice.uniform(0.3f, 0.6f);
  const float lip = neck * dice.uniform(1.1f, 1.7f), belly_at = dice.uniform(0.3f, 0.6f);
  const ProfilePoint points[] = {{foot, 0.003f},
                                 {0.5f * (foot + belly) * 1.08f, height * belly_at * 0.45f},
                                 {belly, height * belly_at},
                                 {0.5f * (belly + neck), height * (0.5f * belly_at + 0.42f)},
                                 {neck, height * 0.86f},
                                 {lip, height}};
  const Profile profile = vessel({smooth_profile(points, 4), height, lip}, 0.004f);
  const Colour ground = dice.colour(kGlazes);
  const float gloss = dice.uniform(0.2f, 0.8f);
  const auto outside = vase.material(
      {.colour = Colour::Ones(),
       .texture = mug_print(kFullTurn * widest(profile), run_length(profile), ground, dice),
       .gloss = gloss,
       .shininess = 70});
  const auto inside = vase.material({.colour = ground * 0.6f, .gloss = 0.1f});
  vase.add(lathe(profile, 40), {outside, inside});
  return std::move(vase).finish();
}

Model make_wine_glass(Dice& dice) {
  Assembly glass("wine glass", Symmetry::kAnyTurn);
  const float height = dice.uniform(0.16f, 0.23f), foot = dice.uniform(0.03f, 0.04f);
  const float bowl_from = height * dice.uniform(0.36f, 0.48f), belly = dice.uniform(0.032f, 0.045f);
  const float rim = belly * dice.uniform(0.72f, 0.92f), stem = dice.uniform(0.003f, 0.0045f);
  const float wine_z = bowl_from + (height - bowl_from) * dice.uniform(0.3f, 0.6f);
  const ProfilePoint bowl[] = {{stem, bowl_from},
                               {belly * 0.75f, bowl_from + 0.14f * (height - bowl_from)},
                               {belly, bowl_from + 0.42f * (height - bowl_from)},
                               {0.5f * (belly + rim), bowl_from + 0.75f * (height - bowl_from)},
                               {rim, height}};
  Profile profile{{0, 0, 0},
                  {foot, 0, 0},
                  {foot, 0.0015f, 0},
                  {0.4f * foot, 0.004f, 0},
                  {1.5f * stem, 0.01f, 0},
                  {stem, 0.02f, 0}};
  const Profile outside = smooth_profile(bowl, 6);
  profile.insert(profile.end(), outside.begin(), outside.end());
  profile.push_back({rim - 0.0012f, height, 0});
  // Where the wine is the glass shows it; opaque materials have to tell the two by their colour.
  const float wine_r = radius_at(outside, wine_z);
  for (auto p = outside.rbegin() + 1; p != outside.rend(); ++p)
    if (p->z > wine_z + 0.002f) profile.push_back({p->r - 0.0012f, p->z, 0});
  profile.push_back({wine_r - 0.0013f, wine_z, 1});
  profile.push_back({0, wine_z, 1});
  for (ProfilePoint& p : profile)
    if (p.z >= bowl_from && p.z < wine_z) p.material = 1;
  constexpr std::uint32_t kWines[] = {0x5a0f1c, 0x7a1525, 0xd8c878, 0xe0a090};
  const auto clear = glass.material(
      {.colour = srgb(0xc4d0d4) * dice.uniform(0.8f, 1.0f), .gloss = 0.9f, .shininess = 120});
  const auto wine =
      glass.material({.colour = dice.colour(kWines), .gloss = 0.9f, .shininess = 120});
  glass.add(lathe(profile, 32), {clear, wine});
  return std::move(glass).finish();
}

}  // namespace cairn
