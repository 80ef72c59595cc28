#include "cairn/synthetic/shapes/loft.h"

#include <algorithm>
#include <cmath>

#include "cairn/geometry/polygon.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

std::vector<float> travelled_around(const Ring& ring) {
  std::vector<float> travelled{0};
  for (std::size_t i = 0; i < ring.size(); ++i)
    travelled.push_back(travelled.back() + (ring[(i + 1) % ring.size()] - ring[i]).norm());
  return travelled;
}

Eigen::Vector3f middle(const Ring& ring) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& p : ring) sum += p;
  return sum / float(ring.size());
}

// The flat end of a body whose inside lies against `outward`.
void add_end(Mesh& mesh, const Ring& ring, bool last) {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // Newell: the area vector
  for (std::size_t i = 0; i < ring.size(); ++i)
    normal += ring[i].cross(ring[(i + 1) % ring.size()]);
  if (normal.norm() < 1e-10f) return;  // the body ends in a point or an edge
  normal.normalize();
  const Eigen::Vector3f x_axis = normal.unitOrthogonal(), y_axis = normal.cross(x_axis);
  Outline flat;
  for (const Eigen::Vector3f& p : ring) flat.emplace_back(p.dot(x_axis), p.dot(y_axis));
  Eigen::Vector2f corner = ring.front().head<2>();
  for (const Eigen::Vector3f& p : ring) corner = corner.cwiseMin(p.head<2>());
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& p : ring)
    mesh.vertices.push_back({p, last ? normal : -normal, {p.y() - corner.y(), p.x() - corner.x()}});
  for (const Eigen::Vector3i& t : polygon_triangles(flat)) {
    const std::uint32_t a = first + std::uint32_t(t[0]), b = first + std::uint32_t(t[1]),
                        c = first + std::uint32_t(t[2]);
    mesh.triangles.push_back(last ? Mesh::Triangle{a, b, c, 0} : Mesh::Triangle{a, c, b, 0});
  }
}

void add_side(Mesh& mesh, std::span<const Ring> rings,
              const std::function<std::uint32_t(int, int)>& material = {}) {
  const int columns = int(rings.front().size());
  std::vector<float> around{0}, along{0};
  for (const Ring& ring : rings) {
    const std::vector<float> lengths = travelled_around(ring);
    if (lengths.back() > around.back()) around = lengths;
  }
  around.resize(std::size_t(columns) + 1, 0.0f);
  for (std::size_t i = 1; i < rings.size(); ++i)
    along.push_back(along.back() + (middle(rings[i]) - middle(rings[i - 1])).norm());
  const int rows = int(rings.size());
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  add_patch(mesh, rows, columns + 1, [&](int row, int column) {
    const int i = rows - 1 - row;
    return Mesh::Vertex{rings[i][column % columns],
                        Eigen::Vector3f::UnitZ(),
                        {around[column], along.back() - along[i]}};
  });
  if (!material) return;
  for (Mesh::Triangle& t : mesh.triangles) {  // a is the upper left corner of its cell
    const int corner = int(t.a - first);
    t.material = material(rows - 2 - corner / (columns + 1), corner % (columns + 1));
  }
}

// Frames that turn as little as the path allows (parallel transport).
std::vector<Eigen::Vector3f> sides_along(const std::vector<Eigen::Vector3f>& directions,
                                         const Eigen::Vector3f& start) {
  std::vector<Eigen::Vector3f> sides;
  Eigen::Vector3f side = start;
  for (const Eigen::Vector3f& direction : directions) {
    side -= side.dot(direction) * direction;
    if (side.norm() < 1e-3f) side = direction.unitOrthogonal();
    side.normalize();
    sides.push_back(side);
  }
  return sides;
}

}  // namespace

Mesh loft(std::span<const Ring> rings, float crease_deg,
          const std::function<std::uint32_t(int, int)>& material) {
  Mesh mesh;
  add_side(mesh, rings, material);
  add_end(mesh, rings.front(), false);
  add_end(mesh, rings.back(), true);
  shade(mesh, crease_deg);
  return mesh;
}

Mesh sweep(const Path& path, const Outline& outline, std::span<const float> scales,
           const Eigen::Vector3f& side, float crease_deg) {
  const int n = int(path.size());
  const bool closed = (path.front() - path.back()).norm() < 1e-6f;
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3f& before = path[i > 0 ? i - 1 : (closed ? n - 2 : 0)];
    const Eigen::Vector3f& after = path[i + 1 < n ? i + 1 : (closed ? 1 : n - 1)];
    directions.push_back((after - before).normalized());
  }
  const std::vector<Eigen::Vector3f> sides = sides_along(directions, side);
  std::vector<Ring> rings;
  for (int i = 0; i < n; ++i) {
    const float scale = scales.empty() ? 1.0f : scales[i];
    const Eigen::Vector3f up = directions[i].cross(sides[i]);
    Ring ring;
    for (const Eigen::Vector2f& p : outline)
      ring.push_back(path[i] + scale * (p.x() * sides[i] + p.y() * up));
    rings.push_back(std::move(ring));
  }
  if (!closed) return loft(rings, crease_deg);
  rings.back() = rings.front();
  Mesh mesh;
  add_side(mesh, rings);
  shade(mesh, crease_deg);
  return mesh;
}

Mesh tube(const Path& path, float radius, int sides) {
  return sweep(path, circle(radius, sides), {}, Eigen::Vector3f::UnitY(), 75);
}

Mesh extrude(const Outline& outline, float height, float bevel, float crease_deg) {
  const auto ring_at = [](const Outline& flat, float z) {
    Ring ring;
    for (const Eigen::Vector2f& p : flat) ring.emplace_back(p.x(), p.y(), z);
    return ring;
  };
  if (bevel <= 0) {
    const Ring rings[] = {ring_at(outline, 0), ring_at(outline, height)};
    return loft(rings, crease_deg);
  }
  const Outline small = inset(outline, bevel);
  const Ring rings[] = {ring_at(small, 0), ring_at(outline, bevel),
                        ring_at(outline, height - bevel), ring_at(small, height)};
  return loft(rings, crease_deg);
}

}  // namespace cairn
