#include "cairn/synthetic/shapes/box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

struct Face {
  Eigen::Vector3f normal, right, down;
};

const std::array<Face, 6>& faces() {
  using V = Eigen::Vector3f;
  static const std::array<Face, 6> kFaces{{
      {V::UnitX(), V::UnitY(), -V::UnitZ()},
      {-V::UnitX(), -V::UnitY(), -V::UnitZ()},
      {V::UnitY(), -V::UnitX(), -V::UnitZ()},
      {-V::UnitY(), V::UnitX(), -V::UnitZ()},
      {V::UnitZ(), V::UnitY(), V::UnitX()},
      {-V::UnitZ(), V::UnitY(), -V::UnitX()},
  }};
  return kFaces;
}

// Where the lines of a face's grid run along a side of the length 2 `half`. The pieces next to the
// ends are those that become the rounded edges.
std::vector<float> grid_lines(float half, const BoxOptions& options) {
  std::vector<float> lines;
  const float inner = half - options.radius;
  if (options.radius > 0) {
    for (int k = options.steps; k > 0; --k) {
      const float angle = std::numbers::pi_v<float> / 4 * float(k) / float(options.steps);
      lines.push_back(k == options.steps ? -half : -inner - options.radius * std::tan(angle));
    }
  }
  const int cells =
      options.cell > 0 ? std::max(1, int(std::ceil(2 * inner / options.cell - 1e-3f))) : 1;
  for (int i = 0; i <= cells; ++i) lines.push_back(-inner + 2 * inner * float(i) / float(cells));
  if (options.radius > 0)
    for (int k = options.steps - 1; k >= 0; --k) lines.push_back(-lines[k]);
  return lines;
}

}  // namespace

Mesh box(const Eigen::Vector3f& size, const BoxOptions& wanted) {
  BoxOptions options = wanted;
  options.radius = std::min(options.radius, 0.499f * size.minCoeff());
  const Eigen::Vector3f half = size / 2;
  const Eigen::Vector3f inner = half - Eigen::Vector3f::Constant(options.radius);
  Mesh mesh;
  for (const Face& face : faces()) {
    const float half_u = face.right.cwiseAbs().dot(half), half_v = face.down.cwiseAbs().dot(half);
    const std::vector<float> u = grid_lines(half_u, options), v = grid_lines(half_v, options);
    add_patch(mesh, int(v.size()), int(u.size()), [&](int i, int j) {
      const Eigen::Vector3f on_cube =
          face.normal * face.normal.cwiseAbs().dot(half) + face.right * u[j] + face.down * v[i];
      const Eigen::Vector3f core = on_cube.cwiseMax(-inner).cwiseMin(inner);
      Mesh::Vertex vertex;
      if (options.radius > 0) {
        vertex.normal = (on_cube - core).normalized();
        vertex.position = core + options.radius * vertex.normal;
      } else {
        vertex.normal = face.normal;
        vertex.position = on_cube;
      }
      vertex.position.z() += half.z();
      vertex.uv = {u[j] + half_u, v[i] + half_v};
      return vertex;
    });
  }
  return mesh;
}

Mesh tapered_box(const Eigen::Vector2f& base, const Eigen::Vector2f& top, float height) {
  Mesh mesh = box({base.x(), base.y(), height});
  const Eigen::Vector2f scale = top.cwiseQuotient(base);
  deform(mesh, [&](const Eigen::Vector3f& p) {
    return p.z() > height / 2 ? Eigen::Vector3f(p.x() * scale.x(), p.y() * scale.y(), p.z()) : p;
  });
  return mesh;
}

Mesh cushion(const Eigen::Vector3f& size, float radius, float bulge) {
  const float cell = std::max(0.05f, size.maxCoeff() / 10);
  Mesh mesh = box(size, {.radius = radius, .steps = 2, .cell = cell});
  const Eigen::Vector3f half = size / 2;
  deform(
      mesh,
      [&](const Eigen::Vector3f& p) {
        const Eigen::Vector3f at =
            Eigen::Vector3f(p.x(), p.y(), p.z() - half.z()).cwiseQuotient(half);
        const Eigen::Vector3f arch = Eigen::Vector3f::Ones() - at.cwiseAbs2();
        Eigen::Vector3f moved = p;
        for (int axis = 0; axis < 3; ++axis) {
          const float others = std::max(0.0f, arch[(axis + 1) % 3] * arch[(axis + 2) % 3]);
          moved[axis] += bulge * at[axis] * others;
        }
        return moved;
      },
      80);
  return mesh;
}

}  // namespace cairn
