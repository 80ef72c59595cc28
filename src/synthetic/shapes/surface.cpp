#include "cairn/synthetic/shapes/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace cairn {
namespace {

Eigen::Vector3f area_vector(const Mesh& mesh, const Mesh::Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t.a].position;
  return (mesh.vertices[t.b].position - a).cross(mesh.vertices[t.c].position - a);
}

// For each vertex the number of its place; vertices at one place share it.
std::vector<int> places(const std::vector<Mesh::Vertex>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Eigen::Vector3f& p = vertices[i].position;
    return std::array<float, 3>{p.x(), p.y(), p.z()};
  };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return key(i) < key(j); });
  std::vector<int> place(vertices.size());
  int count = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && key(order[k]) != key(order[k - 1])) ++count;
    place[order[k]] = count;
  }
  return place;
}

void drop_flat_triangles(Mesh& mesh) {
  std::erase_if(mesh.triangles,
                [&](const Mesh::Triangle& t) { return area_vector(mesh, t).norm() < 1e-11f; });
}

}  // namespace

void add_patch(Mesh& mesh, int rows, int columns,
               const std::function<Mesh::Vertex(int row, int column)>& vertex,
               std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) mesh.vertices.push_back(vertex(i, j));
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Mesh::Triangle triangle{a, b, c, material};
    if (area_vector(mesh, triangle).norm() > 1e-11f) mesh.triangles.push_back(triangle);
  };
  for (int i = 0; i + 1 < rows; ++i) {
    for (int j = 0; j + 1 < columns; ++j) {
      const std::uint32_t a = first + std::uint32_t(i * columns + j), b = a + 1;
      const std::uint32_t c = a + std::uint32_t(columns), d = c + 1;
      add(a, c, d);
      add(a, d, b);
    }
  }
}

void shade(Mesh& mesh, float crease_deg) {
  drop_flat_triangles(mesh);
  const float least_cosine = std::cos(crease_deg * std::numbers::pi_v<float> / 180);
  const std::vector<int> place = places(mesh.vertices);
  const int place_count = place.empty() ? 0 : *std::max_element(place.begin(), place.end()) + 1;
  std::vector<std::vector<int>> faces_at(place_count);
  std::vector<Eigen::Vector3f> area(mesh.triangles.size());
  for (int f = 0; f < int(area.size()); ++f) {
    const Mesh::Triangle& t = mesh.triangles[f];
    area[f] = area_vector(mesh, t);
    for (const std::uint32_t v : {t.a, t.b, t.c}) faces_at[place[v]].push_back(f);
  }

  std::vector<Mesh::Vertex> vertices;
  std::vector<std::vector<std::uint32_t>> copies(mesh.vertices.size());  // of each old vertex
  const auto corner = [&](int f, std::uint32_t old) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (const int g : faces_at[place[old]])
      if (area[f].normalized().dot(area[g].normalized()) >= least_cosine) normal += area[g];
    normal.normalize();
    for (const std::uint32_t copy : copies[old])
      if (vertices[copy].normal.dot(normal) > 0.9999f) return copy;
    copies[old].push_back(static_cast<std::uint32_t>(vertices.size()));
    vertices.push_back({mesh.vertices[old].position, normal, mesh.vertices[old].uv});
    return copies[old].back();
  };
  for (int f = 0; f < int(area.size()); ++f) {
    Mesh::Triangle& t = mesh.triangles[f];
    t = {corner(f, t.a), corner(f, t.b), corner(f, t.c), t.material};
  }
  mesh.vertices = std::move(vertices);
}

void deform(Mesh& mesh, const std::function<Eigen::Vector3f(const Eigen::Vector3f&)>& moved,
            float crease_deg) {
  for (Mesh::Vertex& v : mesh.vertices) v.position = moved(v.position);
  shade(mesh, crease_deg);
}

void print_from_above(Mesh& mesh, const Eigen::Vector2f& corner_xy) {
  for (Mesh::Vertex& v : mesh.vertices)
    v.uv = {v.position.y() - corner_xy.y(), v.position.x() - corner_xy.x()};
}

void print_from_front(Mesh& mesh, const Eigen::Vector2f& corner_yz) {
  for (Mesh::Vertex& v : mesh.vertices)
    v.uv = {v.position.y() - corner_yz.x(), corner_yz.y() - v.position.z()};
}

}  // namespace cairn
