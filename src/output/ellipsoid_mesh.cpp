#include "cairn/output/ellipsoid_mesh.h"

#include <cmath>

namespace cairn {
namespace {

using Eigen::Vector3d;

constexpr int kCircles = 6;   // of latitude, without the poles
constexpr int kCorners = 16;  // of each

int vertex(int circle, int corner) { return 1 + circle * kCorners + corner % kCorners; }

std::vector<Eigen::Vector3i> triangles() {
  std::vector<Eigen::Vector3i> faces;
  constexpr int kNorth = 0, kSouth = 1 + kCircles * kCorners, kLast = kCircles - 1;
  for (int k = 0; k < kCorners; ++k) {
    faces.emplace_back(kNorth, vertex(0, k), vertex(0, k + 1));
    for (int i = 0; i < kLast; ++i) {
      faces.emplace_back(vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1));
      faces.emplace_back(vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1));
    }
    faces.emplace_back(vertex(kLast, k), kSouth, vertex(kLast, k + 1));
  }
  return faces;
}

}  // namespace

TriangleMesh ellipsoid_mesh(const Ellipsoid& ellipsoid) {
  TriangleMesh mesh;
  const auto add = [&](const Vector3d& on_sphere) {
    mesh.vertices.push_back(ellipsoid.T * ellipsoid.semi_axes.cwiseProduct(on_sphere));
  };
  add(Vector3d::UnitZ());
  for (int i = 1; i <= kCircles; ++i) {
    const double polar = M_PI * i / (kCircles + 1);
    for (int k = 0; k < kCorners; ++k) {
      const double turn = 2 * M_PI * k / kCorners;
      add({std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
    }
  }
  add(-Vector3d::UnitZ());
  mesh.triangles = triangles();
  return mesh;
}

}  // namespace cairn
