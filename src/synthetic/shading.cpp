#include "cairn/synthetic/shading.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

constexpr float kSameNormal = 0.9998f;  // cosine of a degree
constexpr float kFaint = 10;            // exp(-10) of a highlight's peak is not seen

using Eigen::Vector2f;
using Eigen::Vector3f;

float luminance(const Colour& colour) {
  return 0.2126f * colour.x() + 0.7152f * colour.y() + 0.0722f * colour.z();
}

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// Schlick (1994): how much more is mirrored at flat angles.
float fresnel(float base, float cosine) {
  const float m = 1 - cosine, m2 = m * m;
  return base + (1 - base) * m2 * m2 * m;
}

// The point of a lamp that the mirrored ray comes nearest to (Karis 2013, "representative point").
Vector3f nearest_point(const AreaLight& light, const Vector3f& at, const Vector3f& ray) {
  const Vector3f normal = light.u.cross(light.v);
  const float slope = ray.dot(normal);
  Vector3f on_plane = light.centre;
  if (std::abs(slope) > 1e-6f) {
    const float distance = (light.centre - at).dot(normal) / slope;
    if (distance > 0) on_plane = at + distance * ray;
  }
  const Vector3f from_centre = on_plane - light.centre;
  const float a = std::clamp(from_centre.dot(light.u) / light.u.squaredNorm(), -1.f, 1.f);
  const float b = std::clamp(from_centre.dot(light.v) / light.v.squaredNorm(), -1.f, 1.f);
  return light.centre + a * light.u + b * light.v;
}

}  // namespace

Shading::Shading(const Scene& scene, const LitMeshes& lit) : scene_(scene), lit_(lit) {
  for (const Mesh& mesh : lit.meshes) {
    std::vector<Surface> surfaces;
    for (const Material& material : mesh.materials) {
      Surface surface{material.colour, material.emission, nullptr, material.gloss,
                      material.shininess};
      if (material.texture) {
        const auto [at, fresh] = textures_.try_emplace(material.texture.get(), *material.texture);
        surface.texture = &at->second;
      }
      surfaces.push_back(surface);
    }
    surfaces_.push_back(std::move(surfaces));
  }
  double sum = 0;
  std::size_t count = 0;
  for (const auto& light : lit.light) {
    for (const Colour& colour : light) sum += double(luminance(colour));
    count += light.size();
  }
  if (count > 0) usual_light_ = float(sum / double(count));
}

Vector3f Shading::normal(const RayHit& hit, const Vector3f& direction) const {
  const Mesh& mesh = lit_.meshes[std::size_t(hit.thing)];
  const auto& t = mesh.triangles[hit.triangle];
  const auto& V = mesh.vertices;
  const Vector3f normal =
      ((1 - hit.u - hit.v) * V[t.a].normal + hit.u * V[t.b].normal + hit.v * V[t.c].normal)
          .normalized();
  return hit.normal.dot(direction) > 0 ? Vector3f(-normal) : normal;
}

Colour Shading::colour(const RayHit& hit, const Vector3f& origin, const Vector3f& direction,
                       float pixel, Highlight& nearby) const {
  if (!hit.found()) return sky(direction);
  const auto thing = std::size_t(hit.thing);
  const Mesh& mesh = lit_.meshes[thing];
  const auto& t = mesh.triangles[hit.triangle];
  const auto &a = mesh.vertices[t.a], &b = mesh.vertices[t.b], &c = mesh.vertices[t.c];
  const auto& vertex_light = lit_.light[thing];
  const float w = 1 - hit.u - hit.v;
  const Colour light =
      w * vertex_light[t.a] + hit.u * vertex_light[t.b] + hit.v * vertex_light[t.c];
  const Surface& surface = surfaces_[thing][t.material];
  Colour albedo = surface.colour, emission = surface.emission;
  Vector3f normal = w * a.normal + hit.u * b.normal + hit.v * c.normal;
  normal.normalize();
  if (hit.normal.dot(direction) > 0) normal = -normal;
  if (surface.texture != nullptr) {
    const Vector2f uv = w * a.uv + hit.u * b.uv + hit.v * c.uv;
    const float cosine = std::max(0.05f, -normal.dot(direction));
    const Colour print = surface.texture->sample(uv, hit.distance * pixel / std::sqrt(cosine));
    albedo = albedo.cwiseProduct(print);
    emission = emission.cwiseProduct(print);
  }
  Colour sum = albedo.cwiseProduct(light) + emission;
  if (surface.gloss > 0) {
    if (nearby.thing != hit.thing || nearby.material != t.material ||
        nearby.normal.dot(normal) < kSameNormal) {
      const Vector3f at = origin + hit.distance * direction;
      nearby = {hit.thing, t.material, normal, mirrored(surface, at, normal, direction, light)};
    }
    sum += nearby.colour;
  }
  return sum;
}

Colour Shading::mirrored(const Surface& surface, const Vector3f& at, const Vector3f& normal,
                         const Vector3f& direction, const Colour& light) const {
  const float facing = std::clamp(-normal.dot(direction), 0.f, 1.f);
  const Vector3f ray = direction + 2 * facing * normal;
  // Nobody asked whether the lamp is seen from here; where little light falls it is not.
  const float lit = std::clamp(luminance(light) / usual_light_, 0.f, 1.f);
  Colour sum = Colour::Zero();
  for (const AreaLight& lamp : scene_.lights) {
    const Vector3f to = nearest_point(lamp, at, ray) - at;
    const float distance = to.norm();
    const Vector3f l = to / distance, cross = lamp.u.cross(lamp.v);
    if (normal.dot(l) <= 0 || cross.dot(l) >= 0) continue;
    const float peak = std::max(0.f, normal.dot((l - direction).normalized()));
    if (surface.shininess * (1 - peak) > kFaint) continue;
    const float solid_angle = -4 * cross.dot(l) / (distance * distance);
    const float spread = std::min(1.f, solid_angle * (surface.shininess + 2) / (2 * float(M_PI)));
    sum += lamp.radiance * (spread * std::pow(peak, surface.shininess));
  }
  sum *= lit * fresnel(0.05f, facing);
  const bool outside = scene_.sky.maxCoeff() > 0;
  const Colour around = Colour::Constant(0.4f * luminance(light));
  const Colour seen =
      outside ? Colour(around + smooth_step(-0.05f, 0.35f, ray.z()) * (sky(ray) - around)) : around;
  return surface.gloss * (sum + 0.6f * fresnel(0.05f, facing) * seen);
}

Colour Shading::sky(const Vector3f& direction) const {
  // Paler towards the horizon.
  const float high = smooth_step(0, 0.7f, direction.z());
  const Colour pale = Colour::Constant(1.15f * scene_.sky.maxCoeff());
  return (1 - 0.7f * high) * pale + 0.7f * high * scene_.sky;
}

}  // namespace cairn
