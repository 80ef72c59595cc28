#include "cairn/synthetic/tessellation.h"

#include <array>
#include <unordered_map>

namespace cairn {
namespace {

constexpr std::uint32_t kWhole = ~0u, kMarked = kWhole - 1;  // instead of a middle's index

class EdgeSplitter {
 public:
  EdgeSplitter(Mesh& mesh, const std::function<bool(std::uint32_t, std::uint32_t)>& wanted)
      : mesh_(mesh), wanted_(wanted) {}

  std::vector<std::pair<std::uint32_t, std::uint32_t>> run() {
    for (const Mesh::Triangle& t : mesh_.triangles) {
      for (const auto& [i, j] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
        const auto [at, fresh] = middles_.try_emplace(key(i, j), kWhole);
        if (fresh && wanted_(std::min(i, j), std::max(i, j))) at->second = kMarked;
      }
    }
    while (mark_longest()) {
    }
    std::vector<Mesh::Triangle> old;
    old.swap(mesh_.triangles);
    mesh_.triangles.reserve(old.size());
    for (const Mesh::Triangle& triangle : old) split(triangle);
    return std::move(split_);
  }

 private:
  static std::uint64_t key(std::uint32_t i, std::uint32_t j) {
    return std::uint64_t(std::min(i, j)) << 32 | std::max(i, j);
  }

  // Whether there was anything to mark.
  bool mark_longest() {
    bool any = false;
    for (const Mesh::Triangle& t : mesh_.triangles) {
      std::uint32_t* longest = nullptr;
      float length = -1;
      bool marked = false;
      for (const auto& [i, j] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
        std::uint32_t& middle = middles_[key(i, j)];
        marked |= middle == kMarked;
        const float squared =
            (mesh_.vertices[i].position - mesh_.vertices[j].position).squaredNorm();
        if (squared > length) length = squared, longest = &middle;
      }
      if (!marked || *longest == kMarked) continue;
      *longest = kMarked;
      any = true;
    }
    return any;
  }

  // The vertex in the middle of an edge, or none if the edge stays whole.
  std::uint32_t middle(std::uint32_t i, std::uint32_t j) {
    std::uint32_t& middle = middles_[key(i, j)];
    if (middle == kMarked) {
      const Mesh::Vertex a = mesh_.vertices[i], b = mesh_.vertices[j];
      middle = std::uint32_t(mesh_.vertices.size());
      split_.emplace_back(std::min(i, j), std::max(i, j));
      mesh_.vertices.push_back({0.5f * (a.position + b.position),
                                (a.normal + b.normal).normalized(), 0.5f * (a.uv + b.uv)});
    }
    return middle;
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
    mesh_.triangles.push_back({a, b, c, material});
  }

  void split(const Mesh::Triangle& triangle) {
    std::array<std::uint32_t, 3> corner = {triangle.a, triangle.b, triangle.c};
    std::array<std::uint32_t, 3> half = {middle(corner[0], corner[1]), middle(corner[1], corner[2]),
                                         middle(corner[2], corner[0])};
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
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;  // by both ends; only looked up
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
