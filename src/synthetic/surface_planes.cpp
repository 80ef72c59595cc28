#include "cairn/synthetic/surface_planes.h"

#include <cmath>

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr double kOnPlane = 1e-4;  // metres

// Counts the edges of the outline that a line from the point crosses, along the two axes in which
// the plane is seen best.
bool inside(const WorldPlane& plane, const Vector3d& X) {
  int skipped = 0;
  plane.normal.cwiseAbs().maxCoeff(&skipped);
  const int u = (skipped + 1) % 3, v = (skipped + 2) % 3;
  bool odd = false;
  const auto& corners = plane.outline;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vector3d &a = corners[i], &b = corners[j];
    if ((a[v] > X[v]) == (b[v] > X[v])) continue;
    odd ^= X[u] < a[u] + (b[u] - a[u]) * (X[v] - a[v]) / (b[v] - a[v]);
  }
  return odd;
}

std::int16_t plane_of(const Scene& scene, const Mesh& mesh, const Mesh::Triangle& t) {
  const Vector3d a = mesh.vertices[t.a].position.cast<double>();
  const Vector3d b = mesh.vertices[t.b].position.cast<double>();
  const Vector3d c = mesh.vertices[t.c].position.cast<double>();
  const Vector3d normal = (b - a).cross(c - a).normalized();
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const WorldPlane& plane = scene.planes[i];
    if (!(normal.dot(plane.normal) > 0.999)) continue;
    bool on = true;
    for (const Vector3d& X : {a, b, c}) {
      on = on && std::abs(plane.normal.dot(X) + plane.d) < kOnPlane + 1e-6 * X.norm();
    }
    if (on && inside(plane, (a + b + c) / 3)) return std::int16_t(i);
  }
  return -1;
}

}  // namespace

SurfacePlanes::SurfacePlanes(const Scene& scene, const std::vector<Mesh>& meshes) {
  for (const Mesh& mesh : meshes) {
    std::vector<std::int16_t> planes;
    planes.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) {
      planes.push_back(cairn::plane_of(scene, mesh, triangle));
    }
    plane_.push_back(std::move(planes));
  }
}

}  // namespace cairn
