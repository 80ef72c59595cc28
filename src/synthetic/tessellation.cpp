#include "cairn/synthetic/tessellation.h"

#include <array>
#include <bit>

namespace cairn {
namespace {

constexpr std::uint32_t kWhole = ~0u, kMarked = kWhole - 1;  // instead of a middle's index

class EdgeSplitter {
 public:
  EdgeSplitter(Mesh& mesh, const std::function<bool(std::uint32_t, std::uint32_t)>& wanted)
      : mesh_(mesh), wanted_(wanted) {}

  std::vector<std::pair<std::uint32_t, std::uint32_t>> run() {
    find_edges();
    bool any = false;
    for (Edge& edge : edges_) {
      if (wanted_(edge.i, edge.j)) edge.middle = kMarked, any = true;
    }
    if (!any) return {};
    while (mark_longest()) {
    }
    std::vector<Mesh::Triangle> old;
    old.swap(mesh_.triangles);
    mesh_.triangles.reserve(2 * old.size());
    for (std::size_t t = 0; t < old.size(); ++t) split(old[t], edges_of_[t]);
    return std::move(split_);
  }

 private:
  struct Edge {
    std::uint32_t i, j;  // i < j
    float squared_length;
    std::uint32_t middle = kWhole;
  };

  void find_edges() {
    // A hash table with open addressing, at most half full.
    std::vector<std::uint32_t> slots(std::bit_ceil(6 * mesh_.triangles.size() + 2), kWhole);
    const auto& V = mesh_.vertices;
    edges_.reserve(2 * mesh_.triangles.size());
    for (const Mesh::Triangle& t : mesh_.triangles) {
      auto& edges = edges_of_.emplace_back();
      auto edge = edges.begin();
      for (const auto& [a, b] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
        const std::uint32_t i = std::min(a, b), j = std::max(a, b);
        std::uint64_t at = (std::uint64_t(i) << 32 | j) * 0x9E3779B97F4A7C15ull >> 32;
        while (true) {
          std::uint32_t& slot = slots[at++ & (slots.size() - 1)];
          if (slot == kWhole) {
            slot = std::uint32_t(edges_.size());
            edges_.push_back({i, j, (V[i].position - V[j].position).squaredNorm()});
          }
          if (edges_[slot].i != i || edges_[slot].j != j) continue;
          *edge++ = slot;
          break;
        }
      }
    }
  }

  // Whether there was anything to mark.
  bool mark_longest() {
    bool any = false;
    for (const auto& [ab, bc, ca] : edges_of_) {
      Edge* longest = &edges_[ab];
      bool marked = false;
      for (const auto e : {ab, bc, ca}) {
        marked |= edges_[e].middle == kMarked;
        if (edges_[e].squared_length > longest->squared_length) longest = &edges_[e];
      }
      if (!marked || longest->middle == kMarked) continue;
      longest->middle = kMarked;
      any = true;
    }
    return any;
  }

  // The vertex in the middle of an edge, or none if the edge stays whole.
  std::uint32_t middle(std::uint32_t index) {
    Edge& edge = edges_[index];
    if (edge.middle == kMarked) {
      const Mesh::Vertex a = mesh_.vertices[edge.i], b = mesh_.vertices[edge.j];
      edge.middle = std::uint32_t(mesh_.vertices.size());
      split_.emplace_back(edge.i, edge.j);
      mesh_.vertices.push_back({0.5f * (a.position + b.position),
                                (a.normal + b.normal).normalized(), 0.5f * (a.uv + b.uv)});
    }
    return edge.middle;
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
    mesh_.triangles.push_back({a, b, c, material});
  }

  void split(const Mesh::Triangle& triangle, const std::array<std::uint32_t, 3>& edges) {
    std::array<std::uint32_t, 3> corner = {triangle.a, triangle.b, triangle.c};
    std::array<std::uint32_t, 3> half = {middle(edges[0]), middle(edges[1]), middle(edges[2])};
    const int count = int(half[0] != kWhole) + int(half[1] != kWhole) + int(half[2] != kWhole);
    const std::uint32_t material = triangle.material;
    // Turned so that the first edge is split and, of two, the last one is whole.
    auto turned = [&] {
      return count == 0 || count == 3 || (half[0] != kWhole && half[2] == kWhole);
    };
    while (!turned()) {
      std::rotate(corner.begin(), corner.begin() + 1, corner.end());
      std::rotate(half.begin(), half.begin() + 1, half.end());
    }
    const auto [a, b, c] = corner;
    const auto [ab, bc, ca] = half;
    if (count == 0) {
      add(a, b, c, material);
    } else if (count == 1) {
      add(a, ab, c, material);
      add(ab, b, c, material);
    } else if (count == 2) {
      add(ab, b, bc, material);
      // The shorter diagonal of what is left.
      const auto& V = mesh_.vertices;
      if ((V[a].position - V[bc].position).squaredNorm() <
          (V[ab].position - V[c].position).squaredNorm()) {
        add(a, ab, bc, material);
        add(a, bc, c, material);
      } else {
        add(a, ab, c, material);
        add(ab, bc, c, material);
      }
    } else {
      add(a, ab, ca, material);
      add(ab, b, bc, material);
      add(ca, bc, c, material);
      add(ab, bc, ca, material);
    }
  }

  Mesh& mesh_;
  const std::function<bool(std::uint32_t, std::uint32_t)>& wanted_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> split_;
  std::vector<Edge> edges_;
  std::vector<std::array<std::uint32_t, 3>> edges_of_;  // of triangle: ab, bc, ca
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> split_edges(
    Mesh& mesh, const std::function<bool(std::uint32_t, std::uint32_t)>& wanted) {
  return EdgeSplitter(mesh, wanted).run();
}

void tessellate(Mesh& mesh, float cell) {
  const auto is_long = [&](std::uint32_t i, std::uint32_t j) {
    return (mesh.vertices[i].position - mesh.vertices[j].position).squaredNorm() > cell * cell;
  };
  while (!split_edges(mesh, is_long).empty()) {
  }
}

}  // namespace cairn
