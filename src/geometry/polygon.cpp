#include "cairn/geometry/polygon.h"

#include <Eigen/Geometry>
#include <numeric>

namespace cairn {
namespace {

float twice_area(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool is_ear(std::span<const Eigen::Vector2f> polygon, const std::vector<int>& left, int i) {
  const int n = int(left.size());
  const Eigen::Vector2f &a = polygon[left[(i + n - 1) % n]], &b = polygon[left[i]],
                        &c = polygon[left[(i + 1) % n]];
  if (twice_area(a, b, c) <= 0) return false;
  for (int k = 2; k + 1 < n; ++k) {
    const Eigen::Vector2f& p = polygon[left[(i + k) % n]];
    if (p == a || p == b || p == c) continue;
    if (twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0)
      return false;
  }
  return true;
}

}  // namespace

Eigen::Vector3d twice_area(std::span<const Eigen::Vector3d> polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return sum;
}

std::vector<Eigen::Vector3i> polygon_triangles(std::span<const Eigen::Vector2f> polygon) {
  std::vector<int> left(polygon.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<Eigen::Vector3i> triangles;
  int at = 0, tried = 0;
  while (left.size() > 2) {
    const int n = int(left.size());
    at %= n;
    // With nothing but flat corners left, any of them will do.
    if (is_ear(polygon, left, at) || tried > n) {
      triangles.emplace_back(left[(at + n - 1) % n], left[at], left[(at + 1) % n]);
      left.erase(left.begin() + at);
      tried = 0;
      at += 1;  // every other corner first: fewer slivers than a fan
    } else {
      ++at;
      ++tried;
    }
  }
  return triangles;
}

}  // namespace cairn
