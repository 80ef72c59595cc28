#include "cairn/synthetic/models/car_body.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

// A curve through points (s, value), with smooth steps between them.
float along(std::initializer_list<Eigen::Vector2f> knots, float s) {
  const Eigen::Vector2f* before = knots.begin();
  if (s <= before->x()) return before->y();
  for (const Eigen::Vector2f& knot : knots) {
    if (s <= knot.x()) {
      const float t = (s - before->x()) / std::max(1e-6f, knot.x() - before->x());
      return before->y() + t * (knot.y() - before->y());
    }
    before = &knot;
  }
  return before->y();
}

}  // namespace

float BodyShape::half_width(float s) const {
  const float l = length;
  const float share = along({{0, 0.78f},
                             {0.012f * l, 0.86f},
                             {0.045f * l, 0.93f},
                             {0.12f * l, 0.975f},
                             {0.25f * l, 1},
                             {0.75f * l, 1},
                             {0.92f * l, 0.965f},
                             {0.975f * l, 0.93f},
                             {l, 0.86f}},
                            s);
  return share * width / 2;
}

float BodyShape::deck(float s) const {
  return along({{0, nose_z - 0.06f},
                {0.012f * length, nose_z},
                {0.06f * length, nose_z + 0.07f},
                {0.5f * cowl, nose_z + 0.72f * (cowl_z - nose_z)},
                {cowl, cowl_z},
                {0.6f * length, belt_z},
                {0.9f * length, tail_z},
                {0.985f * length, tail_z - 0.03f},
                {length, tail_z - 0.1f}},
               s);
}

float BodyShape::top(float s) const {
  const float bonnet_crown = 0.02f;
  const float on_deck = deck(s) + bonnet_crown;
  if (s <= cowl || s >= rear_glass_to) return on_deck;
  const float middle = 0.5f * (roof_from + roof_to), front = cowl_z + bonnet_crown;
  return std::max(on_deck, along({{cowl, front},
                                  {0.5f * (cowl + roof_from), front + 0.53f * (height - front)},
                                  {roof_from, height - 0.05f},
                                  {0.75f * roof_from + 0.25f * middle, height - 0.015f},
                                  {middle, height},
                                  {0.3f * middle + 0.7f * roof_to, height - 0.015f},
                                  {roof_to, height - 0.05f},
                                  {rear_glass_to, deck(rear_glass_to) + bonnet_crown}},
                                 s));
}

float BodyShape::bottom(float s) const {
  float z = along({{0, clearance + 0.08f},
                   {0.06f * length, clearance},
                   {0.92f * length, clearance},
                   {length, clearance + 0.12f}},
                  s);
  const float arch = wheel_radius + 0.05f;
  for (const float axle : {front_axle, rear_axle})
    if (std::abs(s - axle) < arch)
      z = std::max(z, wheel_radius + std::sqrt(arch * arch - (s - axle) * (s - axle)));
  return z;
}

std::vector<Eigen::Vector2f> BodyShape::half_section(float s) const {
  const float w = half_width(s), d = deck(s), t = top(s), b = bottom(s);
  const float glass = std::max(0.0f, t - d - 0.02f);
  const float full = std::clamp(glass / (height - belt_z), 0.0f, 1.0f);
  const auto y = [&](float on_deck, float on_roof) {
    return w * (on_deck + full * (on_roof * tumblehome - on_deck));
  };
  const float crown = 0.02f + 0.02f * full;
  std::vector<Eigen::Vector2f> half(kPoints);
  const float above_arch = std::min(b + 0.07f, d - 0.08f);
  half[kBottom] = {0, b};
  half[kFloorEdge] = {0.93f * w, b};
  half[kSill] = {0.985f * w, b + 0.045f};
  half[kDoor] = {0.995f * w, std::max(clearance + 0.38f * (d - clearance), above_arch)};
  half[kWaist] = {w, std::max(clearance + 0.66f * (d - clearance), above_arch + 0.02f)};
  half[kShoulder] = {0.985f * w, d - 0.05f};
  half[kBelt] = {0.95f * w, d - 0.005f};
  half[kGlassFoot] = {y(0.91f, 0.935f / tumblehome), d + 0.12f * crown + 0.01f * full};
  half[kGlassTop] = {y(0.87f, 1.03f), d + 0.3f * crown + std::max(0.0f, glass - 0.09f * full)};
  half[kRail] = {y(0.76f, 0.93f), t - 0.6f * crown};
  half[kRoofSide] = {y(0.4f, 0.5f), t - 0.15f * crown};
  half[kRoof] = {0, t};
  return half;
}

Eigen::Vector3f BodyShape::at(float s, Point point) const {
  const Eigen::Vector2f p = half_section(s)[point];
  return {length / 2 - s, p.x(), p.y()};
}

Eigen::Vector3f BodyShape::side(float s, float z) const {
  const std::vector<Eigen::Vector2f> half = half_section(s);
  for (int i = kSill; i < kBelt; ++i) {
    const Eigen::Vector2f &a = half[i], &b = half[i + 1];
    if (z > b.y() && i + 1 < kBelt) continue;
    const float share = std::clamp((z - a.y()) / std::max(1e-4f, b.y() - a.y()), 0.0f, 1.0f);
    return {length / 2 - s, a.x() + share * (b.x() - a.x()), z};
  }
  return at(s, kBelt);
}

BodyShape make_body_shape(BodyType type, Dice& dice) {
  struct Kind {
    float length[2], width[2], height[2], belt, nose;
    float cowl, roof_from, roof_to, glass_to;  // shares of the length
  };
  constexpr Kind kKinds[] = {
      {{4.4f, 4.95f}, {1.76f, 1.88f}, {1.41f, 1.48f}, 0.93f, 0.64f, 0.27f, 0.425f, 0.68f, 0.85f},
      {{3.65f, 4.3f}, {1.66f, 1.8f}, {1.44f, 1.54f}, 0.95f, 0.68f, 0.235f, 0.40f, 0.83f, 0.965f},
      {{4.4f, 4.85f}, {1.8f, 1.92f}, {1.5f, 1.75f}, 1.0f, 0.74f, 0.26f, 0.40f, 0.86f, 0.965f},
      {{4.3f, 5.1f}, {1.84f, 1.98f}, {1.82f, 2.05f}, 1.08f, 0.84f, 0.14f, 0.29f, 0.955f, 0.985f},
  };
  const Kind& kind = kKinds[int(type)];
  BodyShape body;
  body.type = type;
  body.length = dice.uniform(kind.length[0], kind.length[1]);
  body.width = dice.uniform(kind.width[0], kind.width[1]);
  body.height = dice.uniform(kind.height[0], kind.height[1]);
  body.clearance = dice.uniform(0.17f, 0.21f) + 0.1f * std::max(0.0f, body.height - 1.5f);
  body.wheel_radius = dice.uniform(0.295f, 0.33f) + 0.1f * std::max(0.0f, body.height - 1.5f);
  body.front_axle = body.length * dice.uniform(0.175f, 0.2f);
  body.rear_axle = body.length * dice.uniform(0.79f, 0.82f);
  const float lift = dice.uniform(-0.02f, 0.03f) +
                     0.25f * (body.height - 0.5f * (kind.height[0] + kind.height[1]));
  body.belt_z = kind.belt + lift;
  body.cowl_z = body.belt_z + dice.uniform(-0.02f, 0.02f);
  body.tail_z = body.belt_z + dice.uniform(0.01f, 0.07f);
  body.nose_z = kind.nose + lift + dice.uniform(-0.03f, 0.03f);
  body.cowl = body.length * (kind.cowl + dice.uniform(-0.01f, 0.015f));
  body.roof_from = body.length * (kind.roof_from + dice.uniform(-0.015f, 0.015f));
  body.roof_to = body.length * (kind.roof_to + dice.uniform(-0.02f, 0.015f));
  body.rear_glass_to = body.length * (kind.glass_to + dice.uniform(-0.01f, 0.008f));
  body.tumblehome = dice.uniform(0.74f, 0.8f) + (type == BodyType::kVan ? 0.08f : 0.0f);
  return body;
}

namespace {

// Where sections are taken: dense where the outline bends, and on both sides of each step.
std::vector<float> stations(const BodyShape& body) {
  const float l = body.length;
  std::vector<float> s{0,         0.006f * l, 0.02f * l,  0.045f * l, 0.08f * l,
                       0.92f * l, 0.95f * l,  0.975f * l, 0.992f * l, l};
  for (const float v : evenly(body.cowl, body.roof_from, 5)) s.push_back(v);
  for (const float v : evenly(body.roof_from, body.roof_to, 9)) s.push_back(v);
  for (const float v : evenly(body.roof_to, body.rear_glass_to, 5)) s.push_back(v);
  // Where the curves along the body have their knots, details lie on it exactly.
  for (const float share : {0.012f, 0.06f, 0.12f, 0.25f, 0.6f, 0.75f, 0.9f, 0.985f})
    s.push_back(share * l);
  for (const float share : {0.33f, 0.5f, 0.75f}) s.push_back(share * body.cowl);
  const float arch = body.wheel_radius + 0.05f;
  for (const float axle : {body.front_axle, body.rear_axle}) {
    for (const float angle : evenly(0, 3.14159265f, 11)) s.push_back(axle - arch * std::cos(angle));
    for (const float side : {-1.0f, 1.0f}) s.push_back(axle + side * (arch + 0.004f));
  }
  // Pillars between the side windows.
  for (const float share : {0.36f, 0.385f, 0.74f, 0.765f}) {
    const float from = body.cowl + 0.1f, to = body.rear_glass_to - 0.1f;
    s.push_back(from + share * (to - from));
  }
  std::sort(s.begin(), s.end(), std::greater<>());
  s.erase(std::unique(s.begin(), s.end(), [](float a, float b) { return a - b < 0.003f; }),
          s.end());
  return s;
}

bool on_pillar(const BodyShape& body, float s) {
  const float from = body.cowl + 0.1f, to = body.rear_glass_to - 0.1f;
  const float share = (s - from) / (to - from);
  return (share > 0.36f && share < 0.385f) || (share > 0.74f && share < 0.765f);
}

}  // namespace

Mesh make_body(const BodyShape& body) {
  const std::vector<float> all = stations(body);
  std::vector<Ring> rings;
  for (const float s : all) {
    const std::vector<Eigen::Vector2f> half = body.half_section(s);
    Ring ring;
    const float x = body.length / 2 - s;
    for (const Eigen::Vector2f& p : half) ring.emplace_back(x, p.x(), p.y());
    for (int i = BodyShape::kRoof - 1; i > 0; --i) ring.emplace_back(x, -half[i].x(), half[i].y());
    rings.push_back(std::move(ring));
  }
  const int points = int(rings.front().size());
  return loft(rings, 38, [&](int ring, int point) -> std::uint32_t {
    const float s = 0.5f * (all[ring] + all[ring + 1]);
    const int k = point < BodyShape::kRoof ? point : points - 1 - point;  // mirrored
    if (k == BodyShape::kBottom) return 2;
    if (k == BodyShape::kFloorEdge) return 4;
    if (k == BodyShape::kWaist && s < 0.07f * body.length) return 5;
    const bool high = k == BodyShape::kWaist || k == BodyShape::kShoulder;
    if (high && s > 0.96f * body.length) return 6;
    const bool windscreen = s > body.cowl && s < body.roof_from;
    const bool rear = s > body.roof_to && s < body.rear_glass_to;
    if (k >= BodyShape::kRail && (windscreen || rear)) return 1;
    const float last = body.type == BodyType::kVan ? 0.55f : 1.0f;
    const bool side =
        s > body.cowl + 0.06f && s < body.cowl + last * (body.rear_glass_to - 0.16f - body.cowl);
    if (side && k == BodyShape::kBelt) return 3;
    if (side && k == BodyShape::kGlassFoot) return on_pillar(body, s) ? 3 : 1;
    return 0;
  });
}

}  // namespace cairn
