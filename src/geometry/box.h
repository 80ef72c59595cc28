#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace cairn {

/// Pixels, x right, y down, pixel centres at integers: the left pixel's left edge is at -0.5.
struct Box2 {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
  double area() const { return width() * height(); }
  /// Has it an area, and only finite numbers?
  bool valid() const { return edges().allFinite() && x1 > x0 && y1 > y0; }
  Eigen::Vector2d centre() const { return {(x0 + x1) / 2, (y0 + y1) / 2}; }
  Eigen::Vector4d edges() const { return {x0, y0, x1, y1}; }
  bool contains(const Eigen::Vector2d& p) const {
    return p.x() >= x0 && p.x() <= x1 && p.y() >= y0 && p.y() <= y1;
  }
  /// The part inside of another box; not valid where they do not meet.
  Box2 clipped(const Box2& to) const {
    return {std::max(x0, to.x0), std::max(y0, to.y0), std::min(x1, to.x1), std::min(y1, to.y1)};
  }
};

/// Area that two boxes share, over the area that at least one covers; 0 where they do not meet.
/// `by_a`: derivative by the edges of the first (may be null); 0 where they do not meet, one-sided
/// where two edges coincide.
inline double intersection_over_union(const Box2& a, const Box2& b,
                                      Eigen::RowVector4d* by_a = nullptr) {
  if (by_a != nullptr) by_a->setZero();
  const Box2 both = a.clipped(b);
  if (!both.valid()) return 0;
  const double shared = both.area(), all = a.area() + b.area() - shared;
  if (by_a != nullptr) {
    const double w = both.width(), h = both.height();
    const Eigen::RowVector4d by_shared(a.x0 > b.x0 ? -h : 0, a.y0 > b.y0 ? -w : 0,
                                       a.x1 < b.x1 ? h : 0, a.y1 < b.y1 ? w : 0);
    const Eigen::RowVector4d by_area(-a.height(), -a.width(), a.height(), a.width());
    *by_a = ((all + shared) * by_shared - shared * by_area) / (all * all);
  }
  return shared / all;
}

}  // namespace cairn
