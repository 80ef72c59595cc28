#include "cairn/synthetic/mesh.h"

#include <utility>

namespace cairn {

std::uint32_t Mesh::add(Material material) {
  materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(materials.size() - 1);
}

void Mesh::append(const Mesh& other, const Eigen::Isometry3f& T) {
  const auto first_vertex = static_cast<std::uint32_t>(vertices.size());
  const auto first_material = static_cast<std::uint32_t>(materials.size());
  vertices.reserve(vertices.size() + other.vertices.size());
  for (const Vertex& v : other.vertices)
    vertices.push_back({T * v.position, T.linear() * v.normal, v.uv});
  triangles.reserve(triangles.size() + other.triangles.size());
  for (const Triangle& t : other.triangles)
    triangles.push_back(
        {t.a + first_vertex, t.b + first_vertex, t.c + first_vertex, t.material + first_material});
  materials.insert(materials.end(), other.materials.begin(), other.materials.end());
}

}  // namespace cairn
