#include "cairn/features/corner_distribution.h"

#include <algorithm>
#include <cmath>

namespace cairn {
namespace {

/// Strongest first; of equal ones the first in reading order, so that the choice is unique.
bool stronger(const FastCorner& a, const FastCorner& b) {
  if (a.score != b.score) return a.score > b.score;
  return a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace

void CornerDistribution::sort_into_cells(std::span<const FastCorner> corners, const Region& region,
                                         int count) {
  const int width = region.x1 - region.x0, height = region.y1 - region.y0;
  const double side = std::max(1.0, std::sqrt(double(width) * height / count));
  columns_ = std::max(1, static_cast<int>(std::lround(width / side)));
  rows_ = std::max(1, static_cast<int>(std::lround(height / side)));
  cells_.assign(static_cast<std::size_t>(columns_) * rows_, {});
  cell_of_.resize(corners.size());
  // 16.16 fixed point: a multiplication a corner instead of a division.
  const std::uint32_t per_x = (std::uint32_t(columns_) << 16) / width;
  const std::uint32_t per_y = (std::uint32_t(rows_) << 16) / height;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t column = ((corners[i].x - region.x0) * per_x) >> 16;
    const std::uint32_t row = ((corners[i].y - region.y0) * per_y) >> 16;
    cell_of_[i] = row * columns_ + column;
    ++cells_[cell_of_[i]].size;
  }
  cursor_.resize(cells_.size());
  std::uint32_t begin = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    cells_[c].begin = cursor_[c] = begin;
    begin += cells_[c].size;
  }
  sorted_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) sorted_[cursor_[cell_of_[i]]++] = corners[i];
}

void CornerDistribution::keep_strong(int threshold) {
  for (Cell& cell : cells_) {
    const auto begin = sorted_.begin() + cell.begin;
    const auto end = std::partition(begin, begin + cell.size, [&](const FastCorner& corner) {
      return corner.score >= threshold;
    });
    if (end != begin) cell.size = static_cast<std::uint32_t>(end - begin);
  }
}

/// The largest q such that all cells together may give q each without exceeding `count`;
/// `left_over` is what is then still missing.
int CornerDistribution::fill_level(int count, int& left_over) const {
  std::uint32_t fullest = 0;
  for (const Cell& cell : cells_) fullest = std::max(fullest, cell.size);
  const auto given = [&](std::uint32_t quota) {
    std::uint64_t sum = 0;
    for (const Cell& cell : cells_) sum += std::min(cell.size, quota);
    return sum;
  };
  std::uint32_t low = 0, high = fullest;
  while (low < high) {
    const std::uint32_t middle = (low + high + 1) / 2;
    if (given(middle) <= static_cast<std::uint64_t>(count)) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  left_over = count - static_cast<int>(given(low));
  return static_cast<int>(low);
}

void CornerDistribution::give(int quota, int left_over, std::vector<FastCorner>& chosen) {
  const auto wanted = static_cast<std::uint32_t>(quota) + 1;  // the next best competes for the rest
  next_best_.clear();
  for (const Cell& cell : cells_) {
    const auto begin = sorted_.begin() + cell.begin;
    std::partial_sort(begin, begin + std::min(wanted, cell.size), begin + cell.size, stronger);
    if (cell.size >= wanted) next_best_.push_back(cell.begin + wanted - 1);
  }
  const auto extra = std::min(static_cast<std::size_t>(left_over), next_best_.size());
  std::partial_sort(
      next_best_.begin(), next_best_.begin() + extra, next_best_.end(),
      [&](std::uint32_t a, std::uint32_t b) { return stronger(sorted_[a], sorted_[b]); });
  next_best_.resize(extra);
  for (const Cell& cell : cells_) {
    const auto begin = sorted_.begin() + cell.begin;
    chosen.insert(chosen.end(), begin, begin + std::min(wanted - 1, cell.size));
  }
  for (const std::uint32_t i : next_best_) chosen.push_back(sorted_[i]);
}

void CornerDistribution::choose(std::span<const FastCorner> corners, const Region& region,
                                int count, int threshold, std::vector<FastCorner>& chosen) {
  chosen.clear();
  if (corners.empty() || count <= 0) return;
  sort_into_cells(corners, region, count);
  keep_strong(threshold);
  int left_over = 0;
  const int quota = fill_level(count, left_over);
  give(quota, left_over, chosen);
}

}  // namespace cairn
