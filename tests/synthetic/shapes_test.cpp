#include <gmock/gmock.h>

#include <numbers>

#include "cairn/geometry/polygon.h"
#include "cairn/synthetic/shapes/box.h"
#include "cairn/synthetic/shapes/lathe.h"
#include "cairn/synthetic/shapes/loft.h"
#include "cairn/synthetic/shapes/surface.h"

namespace cairn {
namespace {

constexpr double kPi = std::numbers::pi;

double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Mesh::Triangle& t : mesh.triangles)
    sum += double(mesh.vertices[t.a]
                      .position.cross(mesh.vertices[t.b].position)
                      .dot(mesh.vertices[t.c].position));
  return sum / 6;
}

TEST(Box, HasItsVolumeWithAndWithoutCells) {
  EXPECT_NEAR(volume(box({1, 2, 3})), 6, 1e-5);
  EXPECT_NEAR(volume(box({1, 2, 3}, {.cell = 0.3f})), 6, 1e-4);
}

TEST(Box, LosesAtItsRoundedEdgesWhatTheyCutAway) {
  const double r = 0.1, inner = 0.8;
  const double rounded = inner * inner * inner + 6 * inner * inner * r + 3 * kPi * inner * r * r +
                         4 * kPi / 3 * r * r * r;
  EXPECT_NEAR(volume(box({1, 1, 1}, {.radius = 0.1f, .steps = 6})), rounded, 1e-3);
}

TEST(Box, PrintsEachFaceFromItsLeftUpperCorner) {
  for (const Mesh::Vertex& v : box({1, 2, 3}).vertices) {
    if (v.normal.x() < 0.5f) continue;
    const Eigen::Vector2f from_corner(v.position.y() + 1, 3 - v.position.z());
    EXPECT_NEAR((v.uv - from_corner).norm(), 0, 1e-5);
  }
}

TEST(Lathe, OfAQuarterCircleIsABall) {
  const Mesh mesh = ball(1, 96);
  EXPECT_NEAR(volume(mesh), 4 * kPi / 3, 0.01);
  for (const Mesh::Vertex& v : mesh.vertices)
    EXPECT_GT(v.normal.dot((v.position - Eigen::Vector3f::UnitZ()).normalized()), 0.99f);
}

TEST(Lathe, UnrollsARunOfOneMaterialOverItsPicture) {
  const ProfilePoint can[] = {{0, 0, 0}, {0.5f, 0, 1}, {0.5f, 2, 0}, {0, 2, 0}};
  const Mesh mesh = lathe(can, 24);
  Eigen::AlignedBox2f label;
  for (const Mesh::Triangle& t : mesh.triangles)
    if (t.material == 1)
      for (const std::uint32_t i : {t.a, t.b, t.c}) label.extend(mesh.vertices[i].uv);
  EXPECT_TRUE(label.min().isZero(1e-5f));
  EXPECT_TRUE(label.max().isApprox(Eigen::Vector2f(float(kPi), 2), 1e-5f));
}

TEST(Shade, KeepsEdgesSharpAndRoundsSmoothOnes) {
  const Mesh prism = extrude(circle(1, 24), 1);  // its sides bend by 15 degrees, its ends by 90
  for (const Mesh::Vertex& v : prism.vertices) {
    const bool end = std::abs(v.normal.z()) > 0.999f;
    const Eigen::Vector2f out = v.position.head<2>().normalized();
    EXPECT_TRUE(end || v.normal.head<2>().dot(out) > 0.999f) << v.normal.transpose();
  }
}

TEST(Sweep, OfACircleAlongARingIsATorus) {
  Path ring;
  for (int i = 0; i <= 64; ++i) {
    const float angle = float(2 * kPi) * float(i % 64) / 64;
    ring.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  EXPECT_NEAR(volume(tube(ring, 0.2f, 32)), 2 * kPi * kPi * 0.04, 0.02);
}

TEST(Extrude, OfAConcaveOutlineCoversItExactly) {
  const Outline angle{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};
  EXPECT_NEAR(volume(extrude(angle, 0.5f)), 0.5 * (3 + 3), 1e-5);
}

TEST(Triangulate, CutsACombIntoTrianglesOfItsArea) {
  Outline comb{{0, 0}, {10, 0}};
  for (int i = 9; i >= 0; --i) {
    comb.emplace_back(i + 0.9f, 5);
    comb.emplace_back(i + 0.4f, 1);
  }
  comb.emplace_back(0.0f, 5);
  const auto cross = [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  double polygon = 0, triangles = 0;
  for (std::size_t i = 0; i < comb.size(); ++i)
    polygon += double(cross(comb[i], comb[(i + 1) % comb.size()])) / 2;
  const auto cut = polygon_triangles(comb);
  for (const Eigen::Vector3i& t : cut) {
    const double area = double(cross(comb[t[1]] - comb[t[0]], comb[t[2]] - comb[t[0]])) / 2;
    EXPECT_GE(area, 0);
    triangles += area;
  }
  EXPECT_EQ(cut.size(), comb.size() - 2);
  EXPECT_NEAR(triangles, polygon, 1e-4);
}

}  // namespace
}  // namespace cairn
