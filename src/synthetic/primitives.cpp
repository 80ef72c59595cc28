#include "cairn/synthetic/primitives.h"

#include <cmath>

namespace cairn {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

// The parallelogram corner + u, v; its texture runs by `du` and `dv` along them.
void add_face(Mesh& mesh, const Vector3f& corner, const Vector3f& u, const Vector3f& v,
              const Vector2f& uv, const Vector2f& du, const Vector2f& dv, std::uint32_t material) {
  const auto first = std::uint32_t(mesh.vertices.size());
  const Vector3f normal = u.cross(v).normalized();
  mesh.vertices.push_back({corner, normal, uv});
  mesh.vertices.push_back({corner + u, normal, uv + du});
  mesh.vertices.push_back({corner + u + v, normal, uv + du + dv});
  mesh.vertices.push_back({corner + v, normal, uv + dv});
  mesh.triangles.push_back({first, first + 1, first + 2, material});
  mesh.triangles.push_back({first, first + 2, first + 3, material});
}

}  // namespace

void add_quad(Mesh& mesh, const Vector3f& corner, const Vector3f& u, const Vector3f& v,
              std::uint32_t material, const Vector2f& uv) {
  add_face(mesh, corner, u, v, uv, {u.norm(), 0}, {0, v.norm()}, material);
}

void add_picture(Mesh& mesh, const Vector3f& left_top, const Vector3f& right, const Vector3f& down,
                 std::uint32_t material, const Vector2f& uv) {
  add_face(mesh, left_top, down, right, uv, {0, down.norm()}, {right.norm(), 0}, material);
}

void add_box(Mesh& mesh, const Vector3f& centre, const Vector3f& size, std::uint32_t material,
             const Vector2f& uv) {
  const Vector3f half = 0.5f * size;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const float side = face % 2 == 0 ? -1.f : 1.f;
    int first = (axis + 1) % 3, second = (axis + 2) % 3;
    if (size[second] > size[first]) std::swap(first, second);
    Vector3f u = Vector3f::Zero(), v = Vector3f::Zero(), normal = Vector3f::Zero();
    u[first] = size[first];
    v[second] = size[second];
    normal[axis] = side;
    if (u.cross(v).dot(normal) < 0) v = -v;
    const Vector3f corner = centre + half[axis] * normal - 0.5f * (u + v);
    add_quad(mesh, corner, u, v, material, uv + Vector2f(0.37f * float(face), 0.61f * float(face)));
  }
}

void add_cylinder(Mesh& mesh, const Vector3f& base, float radius, float top_radius, float height,
                  int sides, std::uint32_t material) {
  const auto first = std::uint32_t(mesh.vertices.size());
  const float slope = (radius - top_radius) / height;
  for (int i = 0; i <= sides; ++i) {  // the seam is there twice, for the texture
    const float angle = 2 * float(M_PI) * float(i) / float(sides);
    const Vector3f out(std::cos(angle), std::sin(angle), 0);
    const Vector3f normal = (out + slope * Vector3f::UnitZ()).normalized();
    const float u = angle * radius;
    mesh.vertices.push_back({base + radius * out, normal, {u, 0}});
    mesh.vertices.push_back(
        {base + top_radius * out + height * Vector3f::UnitZ(), normal, {u, height}});
  }
  for (std::uint32_t i = 0; i < std::uint32_t(sides); ++i) {
    const std::uint32_t a = first + 2 * i;
    mesh.triangles.push_back({a, a + 2, a + 3, material});
    mesh.triangles.push_back({a, a + 3, a + 1, material});
  }
  const auto middle = std::uint32_t(mesh.vertices.size());
  mesh.vertices.push_back({base + height * Vector3f::UnitZ(), Vector3f::UnitZ(), {0, 0}});
  for (int i = 0; i <= sides; ++i) {
    const Vector3f rim = mesh.vertices[first + 2 * std::uint32_t(i) + 1].position;
    mesh.vertices.push_back({rim, Vector3f::UnitZ(), (rim - base).head<2>()});
  }
  for (std::uint32_t i = 0; i < std::uint32_t(sides); ++i) {
    mesh.triangles.push_back({middle, middle + 1 + i, middle + 2 + i, material});
  }
}

}  // namespace cairn
