#include "cairn/synthetic/mesh.h"

#include <utility>

namespace cairn {

std::uint32_t Mesh::add(Material material) {
  materials.push_back(std::move(material));
  return std::uint32_t(materials.size() - 1);
}

void Mesh::append(const Mesh& other, const Eigen::Isometry3f& T) {
  const auto first_vertex = std::uint32_t(vertices.size());
  const auto first_material = std::uint32_t(materials.size());
  vertices.reserve(vertices.size() + other.vertices.size());
  for (const Vertex& vertex : other.vertices) {
    vertices.push_back({T * vertex.position, T.linear() * vertex.normal, vertex.uv});
  }
  triangles.reserve(triangles.size() + other.triangles.size());
  for (const Triangle& triangle : other.triangles) {
    triangles.push_back({triangle.a + first_vertex, triangle.b + first_vertex,
                         triangle.c + first_vertex, triangle.material + first_material});
  }
  materials.insert(materials.end(), other.materials.begin(), other.materials.end());
}

}  // namespace cairn
